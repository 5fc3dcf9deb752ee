# Puts styles and scripts into the template and writes the page as two C++ strings: what comes before the data of a
# network, and what comes after. Run by CMake's -P at build time; page.cmake passes the paths.
set(here ${CMAKE_CURRENT_LIST_DIR})
file(READ ${here}/page.html page)
file(READ ${PAIR_STYLE} pair_style)
file(READ ${here}/style.css style)
string(REPLACE "<!-- STYLE -->" "<style>\n${pair_style}${style}</style>" page "${page}")
set(scripts "")
foreach(name map main)
  file(READ ${here}/${name}.js script)
  string(APPEND scripts "<script>\n${script}</script>\n")
endforeach()
string(REPLACE "<!-- SCRIPTS -->" "${scripts}" page "${page}")

string(FIND "${page}" "<!-- DATA -->" split)
string(SUBSTRING "${page}" 0 ${split} head)
string(SUBSTRING "${page}" ${split} -1 tail)
string(REPLACE "<!-- DATA -->" "" tail "${tail}")
file(WRITE ${OUTPUT} "#include \"network/page.hpp\"\n\nnamespace igsp::cli {\n\n"
  "const std::string_view network_page_head = R\"igsp(${head})igsp\";\n\n"
  "const std::string_view network_page_tail = R\"igsp(${tail})igsp\";\n\n}  // namespace igsp::cli\n")
