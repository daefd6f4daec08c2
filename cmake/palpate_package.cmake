# `cmake --install` and `cpack -G DEB`: a component is a package. What a target installs names its component where the
# target is made (palpate_targets.cmake); here is all else.

# CPack would build the tests, too: scripts/package.sh builds what it packs.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
set(share ${PROJECT_SOURCE_DIR}/share)
set(made ${PROJECT_BINARY_DIR}/package)

# The release and its day, which head CHANGELOG.md.
file(STRINGS CHANGELOG.md release_line REGEX "^## [0-9]" LIMIT_COUNT 1)
if(NOT release_line MATCHES "^## ([0-9.]+) \\(([0-9]+-[0-9]+-[0-9]+)\\)$")
  message(FATAL_ERROR "CHANGELOG.md: '## VERSION (YYYY-MM-DD)' is expected, not '${release_line}'")
endif()
set(release_date ${CMAKE_MATCH_2})
execute_process(COMMAND date --utc -R -d ${release_date} OUTPUT_VARIABLE release_day OUTPUT_STRIP_TRAILING_WHITESPACE)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS CHANGELOG.md)

# --- What a desktop reads -------------------------------------------------------------------------------------------
foreach(app ${PALPATE_APPS})
  install(FILES ${share}/applications/palpate-${app}.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications
          COMPONENT palpate-${app})
  install(FILES ${share}/icons/palpate-${app}.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps
          COMPONENT palpate-${app})
  if(EXISTS ${share}/thumbnailers/palpate-${app}.thumbnailer)
    install(FILES ${share}/thumbnailers/palpate-${app}.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers
            COMPONENT palpate-${app})
  endif()
endforeach()
install(FILES ${share}/applications/palpate-session.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications
        COMPONENT palpate-common)
install(FILES ${share}/mime/palpate.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT palpate-common)
configure_file(${share}/metainfo/palpate.metainfo.xml.in ${made}/example.palpate.Palpate.metainfo.xml @ONLY)
install(FILES ${made}/example.palpate.Palpate.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo
        COMPONENT palpate-common)

# --- Devices: whoever sits at the machine may open those that the drivers know ----------------------------------------
set(known ${PROJECT_SOURCE_DIR}/common/device/driver/transport/usb_search.cpp)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${known})
file(STRINGS ${known} rows REGEX "KnownDevice{{0x")
set(rules "# Devices of Palpate. Made from common/device/driver/transport/usb_search.cpp.\n")
foreach(row ${rows})
  if(row MATCHES "{{0x([0-9a-f]+), 0x([0-9a-f]+)}, \"([^\"]*)\", k")  # those without a driver are nobody's
    string(APPEND rules "# ${CMAKE_MATCH_3}\nSUBSYSTEM==\"usb\", ATTR{idVendor}==\"${CMAKE_MATCH_1}\", "
      "ATTR{idProduct}==\"${CMAKE_MATCH_2}\", TAG+=\"uaccess\"\n")
  endif()
endforeach()
file(CONFIGURE OUTPUT ${made}/70-palpate.rules CONTENT "${rules}" @ONLY)
install(FILES ${made}/70-palpate.rules DESTINATION lib/udev/rules.d COMPONENT palpate-drivers)

# --- Pages: as HTML where there is what makes it ----------------------------------------------------------------------
set(docs ${CMAKE_INSTALL_DATADIR}/doc/palpate-doc)
find_program(PALPATE_CMARK cmark-gfm)
if(PALPATE_CMARK)
  install(CODE "execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/docs_html.sh ${made}/html COMMAND_ERROR_IS_FATAL ANY)"
          COMPONENT palpate-doc)
  install(DIRECTORY ${made}/html DESTINATION ${docs} COMPONENT palpate-doc)
else()
  message(STATUS "cmark-gfm not found: the pages are installed as they are, not as HTML")
  install(FILES README.md CHANGELOG.md CONTRIBUTING.md DESTINATION ${docs} COMPONENT palpate-doc)
  install(DIRECTORY docs DESTINATION ${docs} COMPONENT palpate-doc)
endif()

# --- Packages ---------------------------------------------------------------------------------------------------------
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME palpate)
set(CPACK_PACKAGE_VENDOR "The Palpate authors")
set(CPACK_PACKAGE_CONTACT "The Palpate authors <maintainers@palpate.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # it would head every package's own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Where the library lies that the Python module is linked with: no package has it yet.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)
set(CPACK_COMPONENTS_ALL)

# palpate_debian(palpate-flow SUMMARY … DEPENDS … RECOMMENDS … LICENCE … [DATA]): a package; DATA: the same on every
# machine. Its licence and changelog stand where Debian wants them.
function(palpate_debian name)
  cmake_parse_arguments(arg "DATA" "SUMMARY;DEPENDS;RECOMMENDS;SUGGESTS;LICENCE;SECTION" "" ${ARGN})
  string(TOUPPER ${name} upper)
  set(of CPACK_DEBIAN_${upper})
  list(APPEND CPACK_COMPONENTS_ALL ${name})
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} PARENT_SCOPE)
  set(${of}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(${of}_DESCRIPTION "${arg_SUMMARY}\nPart of Palpate, a suite that explores volumetric data\nwith the eyes and the hand at once."
    PARENT_SCOPE)
  set(${of}_PACKAGE_DEPENDS "${arg_DEPENDS}" PARENT_SCOPE)
  set(${of}_PACKAGE_RECOMMENDS "${arg_RECOMMENDS}" PARENT_SCOPE)
  set(${of}_PACKAGE_SUGGESTS "${arg_SUGGESTS}" PARENT_SCOPE)
  if(arg_SECTION)
    set(${of}_PACKAGE_SECTION ${arg_SECTION} PARENT_SCOPE)
  endif()
  if(arg_DATA)
    set(${of}_PACKAGE_ARCHITECTURE all PARENT_SCOPE)
    set(${of}_PACKAGE_SHLIBDEPS OFF PARENT_SCOPE)
  endif()

  file(READ LICENSE licence)
  string(PREPEND licence "Palpate, in the package ${name}.\n${arg_LICENCE}\n")
  file(CONFIGURE OUTPUT ${made}/${name}/copyright CONTENT "${licence}" @ONLY)
  file(CONFIGURE OUTPUT ${made}/${name}/changelog CONTENT "palpate (${PROJECT_VERSION}) unstable; urgency=medium

  * Release ${PROJECT_VERSION}; CHANGELOG.md of palpate-doc says what is new.

 -- ${CPACK_PACKAGE_CONTACT}  ${release_day}
" @ONLY)
  execute_process(COMMAND gzip -9nkf ${made}/${name}/changelog)
  install(FILES ${made}/${name}/copyright ${made}/${name}/changelog.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${name})
endfunction()

set(same "(= ${PROJECT_VERSION})")
# What dpkg-shlibdeps cannot see: the typeface of the labels, a software rasteriser, and what is opened where a window is.
set(drawn "palpate-common ${same}, fonts-dejavu-core, libegl1, libgl1, libgl1-mesa-dri, libglfw3")
set(summary_flow "explorer of flow fields, with streamlines that state their error")
set(summary_grid "explorer of scalar volumes, through lenses and cuts")
set(summary_cardiac "explorer of hearts, the layers of their walls and fibres")
set(summary_dtmri "explorer of diffusion tensors and tracts")
set(summary_workbench "calibrates haptic devices, trackers and displays")
set(all_apps)
foreach(app ${PALPATE_APPS})
  set(suggests "palpate-doc")
  if(app STREQUAL cardiac)
    string(APPEND suggests ", palpate-mesh")
  endif()
  palpate_debian(palpate-${app} SUMMARY "${summary_${app}}" DEPENDS "${drawn}"
    RECOMMENDS "palpate-drivers ${same}" SUGGESTS "${suggests}")
  list(APPEND all_apps "palpate-${app} ${same}")
endforeach()
palpate_debian(palpate-common SUMMARY "readers of files, and what the programs of Palpate share")
if(TARGET palpate-load-xdmf)
  file(CONFIGURE OUTPUT ${made}/palpate-common/palpate-common CONTENT "\
# Debian has its serial libxdmf in a folder of its own; the one in the library folder is that on MPI.
palpate-common: custom-library-search-path RUNPATH *xdmf/serial*
")
  install(FILES ${made}/palpate-common/palpate-common DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
          COMPONENT palpate-common)
endif()
palpate_debian(palpate-drivers SUMMARY "drivers of haptic devices, and who may open them")
if(TARGET palpate-mesh)
  palpate_debian(palpate-mesh SUMMARY "fills the walls of hearts with tetrahedra, for palpate-cardiac"
    DEPENDS "palpate-cardiac ${same}"
    LICENCE "
The program lib/palpate/palpate-mesh is linked with TetGen (AGPL-3) and CGAL (GPL-3): as a whole it is under the terms
of the GNU Affero General Public License, version 3, <https://www.gnu.org/licenses/agpl-3.0.txt>, which
/usr/share/doc/libtet1.5/copyright has, too. CGAL's are in /usr/share/common-licenses/GPL-3. Its own source is under these:
")
endif()
if(TARGET palpate)
  palpate_debian(libpalpate SUMMARY "fields and lines of Palpate, as a library" SECTION libs DEPENDS "palpate-common ${same}")
  file(CONFIGURE OUTPUT ${made}/triggers CONTENT "activate-noawait ldconfig\n")
  file(CONFIGURE OUTPUT ${made}/shlibs CONTENT
    "libpalpate ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} libpalpate (>= ${PROJECT_VERSION})\n")
  set(CPACK_DEBIAN_LIBPALPATE_PACKAGE_CONTROL_EXTRA ${made}/triggers ${made}/shlibs)
  if(TARGET palpate-mpi)
    palpate_debian(palpate-mpi SUMMARY "traces lines of flow fields on many machines" DEPENDS "palpate-common ${same}")
  endif()
  palpate_debian(libpalpate-dev SUMMARY "fields and lines of Palpate, for programs of one's own" SECTION libdevel
    DEPENDS "libpalpate ${same}")
endif()
if(TARGET palpate_python)
  # A module in C++ is that of one Python: 3.11, and no 3.12.
  get_property(python GLOBAL PROPERTY PALPATE_PYTHON)
  list(GET python 0 major)
  list(GET python 1 minor)
  math(EXPR next "${minor} + 1")
  set(of_python "python3 (>= ${major}.${minor}~), python3 (<< ${major}.${next}~)")
  palpate_debian(python3-palpate SUMMARY "fields and lines of Palpate, in Python" SECTION python
    DEPENDS "libpalpate ${same}, ${of_python}, python3-numpy")
endif()
palpate_debian(palpate-doc SUMMARY "guides and reference pages of Palpate" SECTION doc DATA)
list(JOIN all_apps ", " all_apps)
palpate_debian(palpate SUMMARY "explore volumetric data with the eyes and the hand (metapackage)"
  DEPENDS "${all_apps}" RECOMMENDS "palpate-drivers ${same}, palpate-doc" SUGGESTS "palpate-mesh" DATA)
include(CPack)
