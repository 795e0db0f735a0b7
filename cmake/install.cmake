# cmake --install: libraries, headers, programs, the DBC files, a CMake package and pkg-config files.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(ROADPOSE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/roadpose)
set(ROADPOSE_INSTALLED roadpose roadpose_small)
if(ROADPOSE_PORTS)
    list(APPEND ROADPOSE_INSTALLED roadpose_camera roadpose_camera_small roadpose_can)
    foreach(PROGRAM IN ITEMS roadpose-replay roadpose-listen)
        if(TARGET ${PROGRAM})
            install(TARGETS ${PROGRAM} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
        endif()
    endforeach()
    install(FILES ${PROJECT_SOURCE_DIR}/port/can/roadpose.dbc ${PROJECT_SOURCE_DIR}/port/can/roadpose_p05.dbc
        DESTINATION ${CMAKE_INSTALL_DATADIR}/roadpose)
endif()

install(TARGETS ${ROADPOSE_INSTALLED} EXPORT roadpose-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
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
    set(PKG_LIBS "-l${CORE}")
    if(ROADPOSE_PORTS)
        string(REPLACE roadpose roadpose_camera CAMERA ${CORE})
        set(PKG_LIBS "-l${CAMERA} -lroadpose_can -l${CORE}")
    endif()
    configure_file(${PROJECT_SOURCE_DIR}/cmake/roadpose.pc.in ${PROJECT_BINARY_DIR}/${NAME}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/${NAME}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
file(RELATIVE_PATH PKG_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(REGEX REPLACE "/$" "" PKG_PREFIX ${PKG_PREFIX})
roadpose_install_pkg_config(roadpose roadpose)
roadpose_install_pkg_config(roadpose-small roadpose_small)
