# Puts styles, scripts and licences into the template and writes the page as two C++ strings: what comes before the data
# of a run, and what comes after. Run by CMake's -P at build time; page.cmake passes the paths.
set(here ${CMAKE_CURRENT_LIST_DIR})
file(READ ${here}/page.html page)

function(insert place text)
  string(FIND "${page}" "<!-- ${place} -->" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "page.html has no place for ${place}")
  endif()
  string(REPLACE "<!-- ${place} -->" "${text}" page "${page}")
  set(page "${page}" PARENT_SCOPE)
endfunction()

foreach(part ORBIT_CONTROLS THREE CHART)
  file(READ ${${part}} script)
  if(script MATCHES "</script|<!--")
    message(FATAL_ERROR "${${part}} cannot stand inside of an HTML page as it is")
  endif()
  insert(${part} "<script>${script}</script>")
endforeach()

foreach(part THREE_LICENCE CHART_LICENCE)
  file(READ ${${part}} text)
  string(REPLACE "&" "&amp;" text "${text}")
  string(REPLACE "<" "&lt;" text "${text}")
  insert(${part} "${text}")
endforeach()

file(READ ${here}/style.css style)
insert(STYLE "<style>\n${style}</style>")
set(scripts "")
foreach(name words plots view main)
  file(READ ${here}/${name}.js script)
  string(APPEND scripts "<script>\n${script}</script>\n")
endforeach()
insert(SCRIPTS "${scripts}")

string(FIND "${page}" "<!-- DATA -->" split)
string(SUBSTRING "${page}" 0 ${split} head)
string(SUBSTRING "${page}" ${split} -1 tail)
string(REPLACE "<!-- DATA -->" "" tail "${tail}")
file(WRITE ${OUTPUT} "#include \"report/page.hpp\"\n\nnamespace igsp::cli {\n\n"
  "const std::string_view report_page_head = R\"igsp(${head})igsp\";\n\n"
  "const std::string_view report_page_tail = R\"igsp(${tail})igsp\";\n\n}  // namespace igsp::cli\n")
