# The configuration of CPack for the Debian package (packaging/package.py). The environment gives
# ETENDUE_TREE, the files as they will lie under /, the folder for the package, and the version.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME etendue)
set(CPACK_PACKAGE_VERSION "$ENV{ETENDUE_VERSION}")
set(CPACK_PACKAGE_FILE_NAME etendue_${CPACK_PACKAGE_VERSION})
set(CPACK_PACKAGE_VENDOR "Étendue")
set(CPACK_PACKAGE_CONTACT "The maintainers of Étendue <etendue@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "physically based, spectral Monte Carlo renderer")
set(CPACK_INSTALLED_DIRECTORIES "$ENV{ETENDUE_TREE};/")
set(CPACK_PACKAGING_INSTALL_PREFIX "/")
set(CPACK_PACKAGE_DIRECTORY "$ENV{ETENDUE_DISTRIBUTIONS}")

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE amd64)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_PACKAGE_DESCRIPTION "Étendue renders scenes that are written as text or come from other programs (glTF, USD, Mitsuba, pbrt, common models), with path tracing,
bidirectional path tracing, photon mapping, Metropolis light transport and more. With it come the studio, in which scenes are edited in the
browser while they are rendered, the Python package etendue, and headers for plugins.")
# What the libraries need, from the files themselves; those that lie in the package are found in its folders.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
file(GLOB CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "$ENV{ETENDUE_TREE}/usr/lib/etendue/lib" "$ENV{ETENDUE_TREE}/usr/lib/etendue/native" "$ENV{ETENDUE_TREE}/usr/lib/etendue/x86-64-*")
# The Python package, and the reader of USD.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3 (>= 3.11), python3-numpy")
