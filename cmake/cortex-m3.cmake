# Cortex-M3: emulated board mps2-an385.
set(CMAKE_SYSTEM_PROCESSOR cortex-m3)
set(ROADPOSE_CPU_OPTIONS "-mcpu=cortex-m3 -mfloat-abi=soft")
set(ROADPOSE_BOARD_MEMORY mps2.ld)
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
