# OpenImageIO::OpenImageIO from the library and its headers alone. The configuration file that Debian 12 installs insists
# on the command line tools being there as well, and these bring a whole desktop library with them.
find_path(OpenImageIO_INCLUDE_DIR OpenImageIO/imageio.h)
find_library(OpenImageIO_LIBRARY OpenImageIO)
find_library(OpenImageIO_UTIL_LIBRARY OpenImageIO_Util)
find_package(Imath REQUIRED)

set(OpenImageIO_VERSION "")
if(OpenImageIO_INCLUDE_DIR)
  file(STRINGS ${OpenImageIO_INCLUDE_DIR}/OpenImageIO/oiioversion.h version_lines REGEX "#define OIIO_VERSION_(MAJOR|MINOR|PATCH) ")
  foreach(part MAJOR MINOR PATCH)
    if("${version_lines}" MATCHES "OIIO_VERSION_${part} +([0-9]+)")
      list(APPEND OpenImageIO_VERSION ${CMAKE_MATCH_1})
    endif()
  endforeach()
  list(JOIN OpenImageIO_VERSION . OpenImageIO_VERSION)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenImageIO
  REQUIRED_VARS OpenImageIO_LIBRARY OpenImageIO_UTIL_LIBRARY OpenImageIO_INCLUDE_DIR VERSION_VAR OpenImageIO_VERSION)
mark_as_advanced(OpenImageIO_INCLUDE_DIR OpenImageIO_LIBRARY OpenImageIO_UTIL_LIBRARY)

if(OpenImageIO_FOUND AND NOT TARGET OpenImageIO::OpenImageIO)
  add_library(OpenImageIO::OpenImageIO_Util UNKNOWN IMPORTED)
  set_target_properties(OpenImageIO::OpenImageIO_Util PROPERTIES IMPORTED_LOCATION ${OpenImageIO_UTIL_LIBRARY})
  add_library(OpenImageIO::OpenImageIO UNKNOWN IMPORTED)
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES IMPORTED_LOCATION ${OpenImageIO_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${OpenImageIO_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES "OpenImageIO::OpenImageIO_Util;Imath::Imath")
endif()
