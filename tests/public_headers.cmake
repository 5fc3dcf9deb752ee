# Every public header compiles alone: one generated source per header, built with the tests.
file(GLOB public_headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/include/igsp/*.hpp)
foreach(header igsp/version.hpp ${public_headers})
  string(MAKE_C_IDENTIFIER ${header} name)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/public_headers/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include \"@header@\"\n" @ONLY)
  list(APPEND header_sources ${source})
endforeach()
add_library(public_headers OBJECT ${header_sources})
target_link_libraries(public_headers PRIVATE igsp)
# One unit per header is the point: a unity build would let one header lean on another's includes.
set_target_properties(public_headers PROPERTIES UNITY_BUILD OFF)
