# Cortex-M4: emulated board mps2-an386.
set(CMAKE_SYSTEM_PROCESSOR cortex-m4)
set(ROADPOSE_CPU_OPTIONS "-mcpu=cortex-m4 -mfloat-abi=soft")
set(ROADPOSE_BOARD_MEMORY mps2.ld)
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
