# Puts styles and scripts into the template of a network's page. Run by CMake's -P at build time; page.cmake passes the paths.
set(here ${CMAKE_CURRENT_LIST_DIR})
include(${PAIR_TEMPLATE}/assembly.cmake)
file(READ ${here}/page.html page)

file(READ ${PAIR_TEMPLATE}/style.css pair_style)
file(READ ${here}/style.css style)
insert_our_own("${pair_style}${style}" ${PAIR_TEMPLATE}/shared.js ${here}/frame.js ${here}/cloud.js ${here}/map.js ${here}/tables.js
  ${here}/main.js)
write_page(${OUTPUT} network/page.hpp network_page)
