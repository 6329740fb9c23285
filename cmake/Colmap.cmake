# Builds COLMAP 3.8 with the patches of patches/colmap-3.8 and our engine
# inside. The program is the target colmap_exe, at bin/colmap.

option(TAPA_WITH_GUI "Build COLMAP's graphical user interface" ON)
set(TAPA_COLMAP_BUILD "" CACHE PATH
    "Build folder with the same options, whose compiled COLMAP is taken; empty: none")

set(colmap_dir ${CMAKE_BINARY_DIR}/colmap-3.8)
# COLMAP_SOURCE_DIR may be given in the environment or as -DCOLMAP_SOURCE_DIR. It
# is kept under another name, as COLMAP's own project() takes that one.
set(TAPA_COLMAP_SOURCE_DIR "" CACHE PATH
    "Unpacked source of COLMAP 3.8; empty: Debian's source package")
if(DEFINED ENV{COLMAP_SOURCE_DIR})
  set(source_dir "$ENV{COLMAP_SOURCE_DIR}")
elseif(COLMAP_SOURCE_DIR AND NOT COLMAP_SOURCE_DIR STREQUAL colmap_dir)
  set(source_dir "${COLMAP_SOURCE_DIR}")
else()
  set(source_dir "${TAPA_COLMAP_SOURCE_DIR}")
endif()

set(patches_dir ${CMAKE_SOURCE_DIR}/patches/colmap-3.8)
file(GLOB patches CONFIGURE_DEPENDS ${patches_dir}/*.patch)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
  ${patches_dir}/series ${patches}
  ${CMAKE_SOURCE_DIR}/scripts/prepare_colmap.sh
  ${CMAKE_SOURCE_DIR}/scripts/fetch_colmap.sh)
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env COLMAP_SOURCE_DIR=${source_dir}
          ${CMAKE_SOURCE_DIR}/scripts/prepare_colmap.sh ${colmap_dir}
  RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "The source of COLMAP could not be prepared (see above).")
endif()
set_property(CACHE TAPA_COLMAP_SOURCE_DIR PROPERTY VALUE "${source_dir}")

# COLMAP's sources include some headers of ours, as "src/colmap/...".
file(CREATE_LINK ${CMAKE_SOURCE_DIR}/src ${colmap_dir}/src/src SYMBOLIC)

# COLMAP's own CUDA code does not compile with today's CUDA, and the engine
# replaces the part that matters here.
set(CUDA_ENABLED OFF CACHE BOOL "" FORCE)
set(TESTS_ENABLED OFF CACHE BOOL "" FORCE)
set(CCACHE_ENABLED OFF CACHE BOOL "" FORCE)  # See Ccache.cmake.
set(BOOST_STATIC OFF CACHE BOOL "" FORCE)
set(GUI_ENABLED ${TAPA_WITH_GUI} CACHE BOOL "" FORCE)
set(CMAKE_WARN_DEPRECATED OFF CACHE BOOL "" FORCE)
mark_as_advanced(CUDA_ENABLED TESTS_ENABLED CCACHE_ENABLED BOOST_STATIC
  GUI_ENABLED)
add_subdirectory(${colmap_dir} ${CMAKE_BINARY_DIR}/colmap EXCLUDE_FROM_ALL)

# These leave dense stereo out where there is no CUDA; here it needs none.
set(with_cuda
  ${colmap_dir}/src/controllers/automatic_reconstruction.cc
  ${colmap_dir}/src/exe/mvs.cc
  ${colmap_dir}/src/ui/dense_reconstruction_widget.cc)
set_source_files_properties(${with_cuda} TARGET_DIRECTORY colmap colmap_exe
  PROPERTIES COMPILE_DEFINITIONS CUDA_ENABLED)

# To compile less: what the library has, too, is not compiled for the program again;
# files that include almost the same are compiled several at a time; and the one that
# takes longest takes half the time with -O2, for a mesher that is a sixth slower.
get_target_property(sources colmap_exe SOURCES)
list(REMOVE_ITEM sources feature.cc sfm.cc)
set_target_properties(colmap_exe PROPERTIES SOURCES "${sources}")
get_target_property(sources colmap SOURCES)
set(merged ${sources})
list(FILTER merged INCLUDE REGEX "/src/(base|controllers|sfm|ui|util)/[^/]*\\.cc$")
list(REMOVE_ITEM merged ${with_cuda})
list(REMOVE_ITEM sources ${merged})
set(count 0)
foreach(file ${merged})
  math(EXPR number "${count} / 7")
  math(EXPR count "${count} + 1")
  file(RELATIVE_PATH file ${colmap_dir}/src ${file})
  # UNITY_BUILD names files in full, so that ccache would know them in one folder only.
  string(APPEND content_${number} "#include \"${file}\"\n")
endforeach()
foreach(number RANGE ${number})
  set(file ${CMAKE_BINARY_DIR}/colmap/merged_${number}.cc)
  file(CONFIGURE OUTPUT ${file} CONTENT "${content_${number}}" @ONLY)
  list(APPEND sources ${file})
endforeach()
set_target_properties(colmap PROPERTIES SOURCES "${sources}")
set_source_files_properties(${colmap_dir}/lib/PoissonRecon/PoissonRecon.cpp
  TARGET_DIRECTORY poisson_recon PROPERTIES COMPILE_OPTIONS -O2)

if(TAPA_COLMAP_BUILD)
  foreach(target colmap lsd pba poisson_recon sift_gpu vlfeat)
    get_target_property(dir ${target} BINARY_DIR)
    file(RELATIVE_PATH dir ${CMAKE_BINARY_DIR} ${dir})
    file(GLOB_RECURSE objects CONFIGURE_DEPENDS
      ${TAPA_COLMAP_BUILD}/${dir}/CMakeFiles/${target}.dir/*.o)
    set_target_properties(${target} PROPERTIES
      SOURCES "${objects}" LINKER_LANGUAGE CXX AUTOMOC OFF AUTORCC OFF)
  endforeach()
endif()

# COLMAP declares what it compiles with per folder, not per target.
get_directory_property(colmap_includes
  DIRECTORY ${colmap_dir} INCLUDE_DIRECTORIES)
get_directory_property(colmap_definitions
  DIRECTORY ${colmap_dir} COMPILE_DEFINITIONS)

add_subdirectory(${CMAKE_SOURCE_DIR}/src/colmap ${CMAKE_BINARY_DIR}/src/colmap)
if(TAPA_WITH_GUI)
  add_subdirectory(${CMAKE_SOURCE_DIR}/src/ui ${CMAKE_BINARY_DIR}/src/ui)
endif()

add_custom_target(tapa_colmap_program ALL DEPENDS colmap_exe)
install(TARGETS colmap_exe RUNTIME DESTINATION bin)
install(FILES ${colmap_dir}/doc/COLMAP.desktop DESTINATION share/applications)
