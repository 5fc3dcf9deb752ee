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

# The page runs these scripts and applies this style, and nothing else that may have got into it: their digests stand in
# its content security policy.
set(base64_letters ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/)
function(digest result text)
  string(SHA256 hex "${text}")
  string(APPEND hex 00)  # 12 bits, two letters, at a time
  set(letters "")
  foreach(start RANGE 0 63 3)
    string(SUBSTRING ${hex} ${start} 3 bits)
    math(EXPR first "0x${bits} >> 6")
    math(EXPR second "0x${bits} & 63")
    foreach(place ${first} ${second})
      string(SUBSTRING ${base64_letters} ${place} 1 letter)
      string(APPEND letters ${letter})
    endforeach()
  endforeach()
  string(SUBSTRING ${letters} 0 43 letters)  # of 32 bytes; the last letter is padding
  set(${result} "'sha256-${letters}='" PARENT_SCOPE)
endfunction()
set(script_digests "")

foreach(part ORBIT_CONTROLS THREE CHART)
  file(READ ${${part}} script)
  if(script MATCHES "</script|<!--")
    message(FATAL_ERROR "${${part}} cannot stand inside of an HTML page as it is")
  endif()
  insert(${part} "<script>${script}</script>")
  digest(one "${script}")
  string(APPEND script_digests " ${one}")
endforeach()

foreach(part THREE_LICENCE CHART_LICENCE)
  file(READ ${${part}} text)
  string(REPLACE "&" "&amp;" text "${text}")
  string(REPLACE "<" "&lt;" text "${text}")
  insert(${part} "${text}")
endforeach()

file(READ ${here}/style.css style)
insert(STYLE "<style>${style}</style>")
digest(style_digest "${style}")
set(scripts "")
foreach(name words plots view main)
  file(READ ${here}/${name}.js script)
  string(APPEND scripts "<script>${script}</script>\n")
  digest(one "${script}")
  string(APPEND script_digests " ${one}")
endforeach()
insert(SCRIPTS "${scripts}")
insert(POLICY "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src${script_digests}; \
style-src ${style_digest}; base-uri 'none'; form-action 'none'\">")

string(FIND "${page}" "<!-- DATA -->" split)
string(SUBSTRING "${page}" 0 ${split} head)
string(SUBSTRING "${page}" ${split} -1 tail)
string(REPLACE "<!-- DATA -->" "" tail "${tail}")
file(WRITE ${OUTPUT} "#include \"report/page.hpp\"\n\nnamespace igsp::cli {\n\n"
  "const std::string_view report_page_head = R\"igsp(${head})igsp\";\n\n"
  "const std::string_view report_page_tail = R\"igsp(${tail})igsp\";\n\n}  // namespace igsp::cli\n")
