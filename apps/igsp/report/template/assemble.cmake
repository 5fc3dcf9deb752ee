# Puts styles, scripts and licences into the template of a pair's page. Run by CMake's -P at build time; page.cmake passes
# the paths.
set(here ${CMAKE_CURRENT_LIST_DIR})
include(${here}/assembly.cmake)
file(READ ${here}/page.html page)

foreach(part ORBIT_CONTROLS THREE CHART)
  insert_library(${part} ${${part}})
endforeach()
foreach(part THREE_LICENCE CHART_LICENCE)
  file(READ ${${part}} text)
  string(REPLACE "&" "&amp;" text "${text}")
  string(REPLACE "<" "&lt;" text "${text}")
  insert(${part} "${text}")
endforeach()

file(READ ${here}/style.css style)
insert_our_own("${style}" ${here}/words.js ${here}/plots.js ${here}/shared.js ${here}/view.js ${here}/main.js)
write_page(${OUTPUT} report/page.hpp report_page)
