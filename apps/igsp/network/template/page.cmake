# The page of a network, as a source file for the igsp command. Sets network_page_source. It draws by itself; the colours,
# the frame, the policy and some functions are those of the page of a pair.
set(network_page_source ${CMAKE_CURRENT_BINARY_DIR}/network_page_text.cpp)
set(network_template ${CMAKE_CURRENT_LIST_DIR})
set(pair_template ${CMAKE_CURRENT_LIST_DIR}/../../report/template)
add_custom_command(OUTPUT ${network_page_source}
  COMMAND ${CMAKE_COMMAND} -DOUTPUT=${network_page_source} -DPAIR_TEMPLATE=${pair_template} -P ${network_template}/assemble.cmake
  DEPENDS ${network_template}/assemble.cmake ${network_template}/page.html ${network_template}/style.css
    ${network_template}/frame.js ${network_template}/cloud.js ${network_template}/map.js ${network_template}/tables.js
    ${network_template}/main.js ${pair_template}/shared.js ${pair_template}/style.css ${pair_template}/assembly.cmake
  COMMENT "Assembling the page of a network" VERBATIM)
