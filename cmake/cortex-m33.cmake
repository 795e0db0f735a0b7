# Cortex-M33: emulated board mps2-an505.
set(CMAKE_SYSTEM_PROCESSOR cortex-m33)
set(ROADPOSE_CPU_OPTIONS "-mcpu=cortex-m33 -mfloat-abi=soft")
set(ROADPOSE_BOARD_MEMORY mps2_an505.ld)
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
