# `cpack` makes two Debian packages of what is installed: igsp, the command, and libigsp-dev, the static library.
if(BUILD_SHARED_LIBS OR NOT IGSP_BUILD_APPS)
  return()
endif()
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # tests and benchmarks need not be built to make a package
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME igsp)
set(CPACK_PACKAGE_CONTACT "The igsp developers")
set(CPACK_COMPONENTS_ALL command development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME igsp)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "The igsp command: finds the rigid motion that puts one 3D point cloud onto
another and says whether to believe it.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libigsp-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# What igspConfig.cmake looks for.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4), libtbb-dev, libfmt-dev, liblzf-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers, static library and CMake package of igsp, for C++20.")
include(CPack)
