# One target to link: roadpose_unity, the Unity test framework, from the first of these that there is:
#   1. an installed package (find_package);
#   2. the sources in ROADPOSE_UNITY_DIR (the folder that holds unity.c; run.sh prepares one from Debian's archive);
#   3. the pinned release, downloaded.
set(ROADPOSE_UNITY_DIR "" CACHE PATH "folder with unity.c and unity.h, used when no Unity package is installed")

function(roadpose_unity_from FOLDER)
    add_library(roadpose_unity STATIC ${FOLDER}/unity.c)
    target_include_directories(roadpose_unity SYSTEM PUBLIC ${FOLDER})
endfunction()

find_package(unity QUIET)
if(TARGET unity::framework)
    add_library(roadpose_unity INTERFACE)
    target_link_libraries(roadpose_unity INTERFACE unity::framework)
    message(STATUS "Unity: installed package ${unity_DIR}")
elseif(ROADPOSE_UNITY_DIR)
    roadpose_unity_from(${ROADPOSE_UNITY_DIR})
    message(STATUS "Unity: ${ROADPOSE_UNITY_DIR}")
else()
    include(FetchContent)
    # The checksum of the release archive, as several package recipes (xmake-repo, Arch, Bazel workspaces) pin it.
    FetchContent_Declare(unity_release
        URL https://github.com/ThrowTheSwitch/Unity/archive/refs/tags/v2.5.2.tar.gz
        URL_HASH SHA256=3786de6c8f389be3894feae4f7d8680a02e70ed4dbcce36109c8f8646da2671a)
    FetchContent_GetProperties(unity_release)
    if(NOT unity_release_POPULATED)
        FetchContent_Populate(unity_release) # only the sources: its own CMake project installs things
    endif()
    roadpose_unity_from(${unity_release_SOURCE_DIR}/src)
    message(STATUS "Unity: release 2.5.2, downloaded")
endif()
