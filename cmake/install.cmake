# cmake --install: libraries, headers, programs, the DBC files, a CMake package and pkg-config files.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(ROADPOSE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/roadpose)
foreach(PROGRAM IN ITEMS roadpose-replay roadpose-listen)
    if(TARGET ${PROGRAM})
        install(TARGETS ${PROGRAM} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    endif()
endforeach()
install(TARGETS roadpose roadpose_small roadpose_camera roadpose_camera_small roadpose_can EXPORT roadpose-targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/port/can/roadpose.dbc ${PROJECT_SOURCE_DIR}/port/can/roadpose_p05.dbc
    DESTINATION ${CMAKE_INSTALL_DATADIR}/roadpose)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/roadpose DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/roadpose)

install(EXPORT roadpose-targets NAMESPACE roadpose:: DESTINATION ${ROADPOSE_PACKAGE_DIR})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/roadpose-config.cmake.in
    ${PROJECT_BINARY_DIR}/roadpose-config.cmake INSTALL_DESTINATION ${ROADPOSE_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/roadpose-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/roadpose-config.cmake ${PROJECT_BINARY_DIR}/roadpose-config-version.cmake
    DESTINATION ${ROADPOSE_PACKAGE_DIR})

# roadpose_install_pkg_config(NAME CORE): one file for each build of the core. Whoever compiles against it must see the
# limits that it was built with, so they are part of the flags.
function(roadpose_install_pkg_config NAME CORE)
    get_target_property(LIMITS ${CORE} COMPILE_DEFINITIONS)
    set(PKG_FLAGS "-I\${includedir}")
    if(LIMITS)
        list(TRANSFORM LIMITS PREPEND " -D")
        string(APPEND PKG_FLAGS ${LIMITS})
    endif()
    set(PKG_NAME ${NAME})
    string(REPLACE roadpose roadpose_camera CAMERA ${CORE})
    set(PKG_LIBS "-l${CAMERA} -lroadpose_can -l${CORE}")
    configure_file(${PROJECT_SOURCE_DIR}/cmake/roadpose.pc.in ${PROJECT_BINARY_DIR}/${NAME}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/${NAME}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
# Relative to the file, so that an installation can be moved; a packager's absolute folders are taken as they are.
if(IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
    string(REPLACE " " "\\ " PKG_PREFIX ${CMAKE_INSTALL_PREFIX})
else()
    file(RELATIVE_PATH PKG_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
    string(REGEX REPLACE "/$" "" PKG_PREFIX "\${pcfiledir}/${PKG_PREFIX}")
endif()
foreach(FOLDER IN ITEMS INCLUDEDIR LIBDIR)
    set(PKG_${FOLDER} ${CMAKE_INSTALL_${FOLDER}})
    if(NOT IS_ABSOLUTE ${CMAKE_INSTALL_${FOLDER}})
        set(PKG_${FOLDER} "\${prefix}/${CMAKE_INSTALL_${FOLDER}}")
    endif()
    string(REPLACE " " "\\ " PKG_${FOLDER} ${PKG_${FOLDER}})
endforeach()
roadpose_install_pkg_config(roadpose roadpose)
roadpose_install_pkg_config(roadpose-small roadpose_small)
