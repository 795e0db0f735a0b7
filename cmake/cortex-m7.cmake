# Cortex-M7: emulated board mps2-an500.
set(CMAKE_SYSTEM_PROCESSOR cortex-m7)
set(ROADPOSE_CPU_OPTIONS "-mcpu=cortex-m7 -mfloat-abi=soft")
set(ROADPOSE_BOARD_MEMORY mps2_an500.ld)
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
