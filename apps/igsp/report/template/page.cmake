# The report page: our template with the drawing libraries of Debian inside, as a source file for the igsp command.
# Sets report_page_source. The libraries stay out of the repository.
function(find_page_part variable path package)
  get_filename_component(name ${path} NAME)
  get_filename_component(folder ${path} DIRECTORY)
  find_file(${variable} ${name} PATHS ${folder} NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH
    DOC "Part of the report page, from ${package}")
  if(NOT EXISTS "${${variable}}")
    message(FATAL_ERROR "The report page needs ${path}: install the Debian package ${package} "
      "(scripts/setup.sh installs all that is needed), or say where it is with -D${variable}=FILE")
  endif()
endfunction()

find_page_part(IGSP_THREE_JS /usr/share/javascript/three/three.min.js libjs-three)
find_page_part(IGSP_ORBIT_CONTROLS_JS /usr/share/javascript/three/examples/js/controls/OrbitControls.js libjs-three)
find_page_part(IGSP_THREE_LICENCE /usr/share/doc/libjs-three/copyright libjs-three)
find_page_part(IGSP_CHART_JS /usr/share/javascript/chart.js/chart.min.js libjs-chart.js)
find_page_part(IGSP_CHART_LICENCE /usr/share/doc/libjs-chart.js/copyright libjs-chart.js)

set(report_page_source ${CMAKE_CURRENT_BINARY_DIR}/report_page_text.cpp)
set(page_template ${CMAKE_CURRENT_LIST_DIR})
add_custom_command(OUTPUT ${report_page_source}
  COMMAND ${CMAKE_COMMAND} -DOUTPUT=${report_page_source} -DTHREE=${IGSP_THREE_JS}
    -DORBIT_CONTROLS=${IGSP_ORBIT_CONTROLS_JS} -DTHREE_LICENCE=${IGSP_THREE_LICENCE}
    -DCHART=${IGSP_CHART_JS} -DCHART_LICENCE=${IGSP_CHART_LICENCE} -P ${page_template}/assemble.cmake
  DEPENDS ${page_template}/assemble.cmake ${page_template}/assembly.cmake ${page_template}/page.html ${page_template}/style.css
    ${page_template}/shared.js ${page_template}/view.js ${page_template}/plots.js ${page_template}/words.js ${page_template}/main.js
    ${IGSP_THREE_JS} ${IGSP_ORBIT_CONTROLS_JS} ${IGSP_CHART_JS} ${IGSP_THREE_LICENCE} ${IGSP_CHART_LICENCE}
  COMMENT "Assembling the report page" VERBATIM)
