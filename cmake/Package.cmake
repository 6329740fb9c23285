# Makes a .deb of the installed program: scripts/package.sh.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME colmap-tapa)
set(CPACK_PACKAGE_CONTACT "TAPA-MVS for COLMAP <tapa-mvs@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY
  "COLMAP with dense stereo for all machines and untextured surfaces")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
  "COLMAP 3.8 turns photographs into 3D. In this build its dense stereo runs on
CPUs, and optionally completes walls, floors and tables by TAPA-MVS. The
commands and files are those of COLMAP.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# It takes the place of Debian's package, whose files have the same names.
set(CPACK_DEBIAN_PACKAGE_PROVIDES "colmap (= 3.8)")
set(CPACK_DEBIAN_PACKAGE_CONFLICTS colmap)
set(CPACK_DEBIAN_PACKAGE_REPLACES colmap)
# Tests and benchmarks need not be built for it.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
include(CPack)

# What the program comes under.
set(doc_dir share/doc/${CPACK_PACKAGE_NAME})
install(FILES LICENSE DESTINATION ${doc_dir} RENAME copyright)
install(FILES ${colmap_dir}/COPYING.txt DESTINATION ${doc_dir}
  RENAME copyright.colmap)
file(GLOB licences ${colmap_dir}/lib/*/LICENSE)
foreach(licence ${licences})
  get_filename_component(library ${licence} DIRECTORY)
  get_filename_component(library ${library} NAME)
  install(FILES ${licence} DESTINATION ${doc_dir} RENAME copyright.${library})
endforeach()
