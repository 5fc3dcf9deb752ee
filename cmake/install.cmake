# What `cmake --install` lays down: headers, library, command, and the package that find_package(igsp) reads.
include(CMakePackageConfigHelpers)
set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/igsp)

# Two components, which become the packages igsp and libigsp-dev: `command` is what runs, `development` what others
# build with.
install(TARGETS igsp EXPORT igsp ARCHIVE COMPONENT development
  LIBRARY COMPONENT command NAMELINK_COMPONENT development)
if(IGSP_BUILD_APPS)
  install(TARGETS igsp_app COMPONENT command)
endif()
install(FILES ${CMAKE_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT command)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT command)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libigsp-dev RENAME copyright
  COMPONENT development)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/include/igsp ${CMAKE_BINARY_DIR}/include/igsp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.hpp")
install(EXPORT igsp NAMESPACE igsp:: FILE igspTargets.cmake DESTINATION ${package_directory} COMPONENT development)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/igspConfig.cmake.in ${CMAKE_BINARY_DIR}/cmake/igspConfig.cmake
  INSTALL_DESTINATION ${package_directory})
# Before 1.0 the minor version is the one that may break a caller.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/cmake/igspConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/cmake/igspConfig.cmake ${CMAKE_BINARY_DIR}/cmake/igspConfigVersion.cmake
  DESTINATION ${package_directory} COMPONENT development)
