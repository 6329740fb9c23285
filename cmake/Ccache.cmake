# Compiles through ccache when it is there, such that a build of the same
# sources in another folder hits as well: ccache turns paths below the base
# folder into relative ones, and does not hash the working folder.

option(TAPA_CCACHE "Compile through ccache when it is installed" ON)

if(TAPA_CCACHE)
  find_program(TAPA_CCACHE_PROGRAM ccache)
  mark_as_advanced(TAPA_CCACHE_PROGRAM)
endif()

if(TAPA_CCACHE AND TAPA_CCACHE_PROGRAM)
  # COLMAP, by far the largest part, is compiled from a copy in the build
  # folder, so that one counts where it does not lie below the source folder.
  string(FIND "${CMAKE_BINARY_DIR}/" "${CMAKE_SOURCE_DIR}/" position)
  if(position EQUAL 0)
    set(base_dir ${CMAKE_SOURCE_DIR})
  else()
    set(base_dir ${CMAKE_BINARY_DIR})
  endif()
  set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${base_dir}
               CCACHE_NOHASHDIR=1 ${TAPA_CCACHE_PROGRAM})
  foreach(language C CXX CUDA)
    if(NOT CMAKE_${language}_COMPILER_LAUNCHER)
      set(CMAKE_${language}_COMPILER_LAUNCHER ${launcher})
    endif()
  endforeach()
endif()
