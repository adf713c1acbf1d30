# OpenVDB, TBB, libnifti, GDCM and Assimp as Debian 12 has them. Debian's FindOpenVDB.cmake is not used: it sets
# BUILD_SHARED_LIBS in its caller and asks for libboost-iostreams-dev.
include(CMakeFindDependencyMacro)
find_dependency(TBB)
find_dependency(assimp)
find_dependency(ZLIB)

function(_palpate_import target header library)
  if(TARGET ${target})
    return()
  endif()
  string(MAKE_C_IDENTIFIER ${target} id)
  find_path(${id}_INCLUDE_DIR ${header} PATH_SUFFIXES ${ARGN})
  find_library(${id}_LIBRARY ${library})
  mark_as_advanced(${id}_INCLUDE_DIR ${id}_LIBRARY)
  if(NOT ${id}_INCLUDE_DIR OR NOT ${id}_LIBRARY)
    message(FATAL_ERROR "palpate: ${header} or lib${library} was not found; "
      "tools/test.sh installs all that is needed")
  endif()
  add_library(${target} SHARED IMPORTED GLOBAL)
  set_target_properties(${target} PROPERTIES
    IMPORTED_LOCATION ${${id}_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${${id}_INCLUDE_DIR}
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${${id}_INCLUDE_DIR})
endfunction()

_palpate_import(palpate_external::imath Imath/half.h Imath-3_1)
_palpate_import(palpate_external::openvdb openvdb/openvdb.h openvdb)
# nifti1_io.h includes znzlib.h by its bare name, so its own folder is the include directory.
_palpate_import(palpate_external::znz znzlib.h znz nifti)
_palpate_import(palpate_external::nifti nifti2_io.h nifti2 nifti)
_palpate_import(palpate_external::nifticdf nifticdf.h nifticdf nifti)
set_property(TARGET palpate_external::openvdb PROPERTY
  INTERFACE_LINK_LIBRARIES palpate_external::imath TBB::tbb)
set_property(TARGET palpate_external::nifti PROPERTY
  INTERFACE_LINK_LIBRARIES palpate_external::nifticdf palpate_external::znz ZLIB::ZLIB m)

# Debian's GDCMConfig.cmake asks for packages that reading does not need.
_palpate_import(palpate_external::gdcm gdcmImageReader.h gdcmMSFF gdcm-3.0)
_palpate_import(palpate_external::gdcm_dsed gdcmDataSet.h gdcmDSED gdcm-3.0)
_palpate_import(palpate_external::gdcm_common gdcmTrace.h gdcmCommon gdcm-3.0)
set_property(TARGET palpate_external::gdcm PROPERTY
  INTERFACE_LINK_LIBRARIES palpate_external::gdcm_dsed palpate_external::gdcm_common)
