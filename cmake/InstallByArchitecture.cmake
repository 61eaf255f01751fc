# What packages hold (packaging/), the component "by_architecture" of the installation: builds for several architectures share one
# prefix. A folder named by the architecture holds what has to be compiled alike, as spectra are passed in its registers: the
# library, what it loads, the program, the Python extension. Everything else is there once.
#
#   PREFIX/x86-64-v3/               etendue, libetendue.so.0.2 and the libraries that it loads, _core.….so
#   PREFIX/lib/                     libraries of others, where the package brings them
#   PREFIX/libexec/etendue/         programs that read files of other programs
#   PREFIX/share/etendue/           the studio's page; what chooses an architecture
#   PREFIX/include, PREFIX/lib/cmake   for plugins

function(install_part)
  install(${ARGN} COMPONENT by_architecture EXCLUDE_FROM_ALL)
endfunction()

set(own ${ETENDUE_ARCHITECTURE})
set_property(TARGET etendue_program APPEND PROPERTY INSTALL_RPATH "$ORIGIN")

install(TARGETS etendue EXPORT etendueByArchitecture
  LIBRARY DESTINATION ${own} COMPONENT by_architecture EXCLUDE_FROM_ALL NAMELINK_SKIP)
install(TARGETS etendue_options EXPORT etendueByArchitecture)
install_part(TARGETS etendue_app etendue_commands etendue_formats etendue_laboratory etendue_osl etendue_studio LIBRARY DESTINATION ${own})
install_part(TARGETS etendue_program RUNTIME DESTINATION ${own})
if(ETENDUE_BUNDLED_OPENIMAGEIO)
  set_property(TARGET etendue_bundled_openimageio PROPERTY INSTALL_RPATH "$ORIGIN:$ORIGIN/../lib")
  install_part(TARGETS etendue_bundled_openimageio LIBRARY DESTINATION ${own})
  install_part(FILES ${bundled_openimageio} DESTINATION lib)
else()
  install_part(TARGETS etendue_openimageio LIBRARY DESTINATION ${own})
endif()

install_part(TARGETS etendue_assimp etendue_draco RUNTIME DESTINATION libexec/etendue)
install_part(PROGRAMS ${python_readers} DESTINATION libexec/etendue)
install_part(FILES ${CMAKE_BINARY_DIR}/studio/index.html DESTINATION share/etendue/studio OPTIONAL)
install_part(FILES packaging/architectures.txt DESTINATION share/etendue)
install_part(DIRECTORY include/etendue DESTINATION include)

configure_package_config_file(cmake/etendueByArchitecture.cmake.in by_architecture/etendueConfig.cmake INSTALL_DESTINATION lib/cmake/etendue)
install_part(FILES ${CMAKE_BINARY_DIR}/by_architecture/etendueConfig.cmake ${CMAKE_BINARY_DIR}/etendueConfigVersion.cmake
  cmake/etendueAddPlugin.cmake DESTINATION lib/cmake/etendue)
install_part(EXPORT etendueByArchitecture FILE etendueTargets.cmake NAMESPACE etendue:: DESTINATION lib/cmake/etendue/${own})

# Of etendue.build_info(): what this architecture's library was compiled with.
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/by_architecture/build.json CONTENT "{
  \"version\": \"${PROJECT_VERSION}\",
  \"architecture\": \"${ETENDUE_ARCHITECTURE}\",
  \"compiler\": \"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\",
  \"build_type\": \"${CMAKE_BUILD_TYPE}\"
}
")
install_part(FILES ${CMAKE_BINARY_DIR}/by_architecture/build.json DESTINATION ${own})
