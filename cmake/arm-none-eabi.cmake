# What the toolchain files of all Cortex-M cores share. Set before: ROADPOSE_CPU_OPTIONS, CMAKE_SYSTEM_PROCESSOR,
# ROADPOSE_BOARD_MEMORY (linker script of the board, in port/cortex_m).
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_C_FLAGS_INIT "-mthumb ${ROADPOSE_CPU_OPTIONS} -ffunction-sections -fdata-sections")
