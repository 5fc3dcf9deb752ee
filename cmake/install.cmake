# What `cmake --install` lays down: headers, library, command, and the package that find_package(igsp) reads.
include(CMakePackageConfigHelpers)
set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/igsp)

install(TARGETS igsp EXPORT igsp)
if(IGSP_BUILD_APPS)
  install(TARGETS igsp_app)
endif()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/include/igsp ${CMAKE_BINARY_DIR}/include/igsp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
install(EXPORT igsp NAMESPACE igsp:: FILE igspTargets.cmake DESTINATION ${package_directory})

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/igspConfig.cmake.in ${CMAKE_BINARY_DIR}/cmake/igspConfig.cmake
  INSTALL_DESTINATION ${package_directory})
# Before 1.0 the minor version is the one that may break a caller.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/cmake/igspConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/cmake/igspConfig.cmake ${CMAKE_BINARY_DIR}/cmake/igspConfigVersion.cmake
  DESTINATION ${package_directory})
