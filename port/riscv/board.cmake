# roadpose_board(NAME LIBRARY_RAM_BYTES): start-up, memory layout and semihosting of the C library (picolibc), for the
# memory of QEMU's board "virt". How much RAM the library may have is checked on the Cortex-M boards.
function(roadpose_board NAME LIBRARY_RAM_BYTES)
    target_sources(${NAME} PRIVATE ${PROJECT_SOURCE_DIR}/port/riscv/board.c
        ${PROJECT_SOURCE_DIR}/port/riscv/stat.c command_line.c library_stack.c)
    # Reading the counter is an extension to the assembler, for which there is no library variant.
    set_source_files_properties(${PROJECT_SOURCE_DIR}/port/riscv/board.c PROPERTIES COMPILE_OPTIONS -march=rv32imac_zicsr)
    target_link_options(${NAME} PRIVATE --oslib=semihost --crt0=hosted -Wl,--gc-sections
        -Wl,--defsym=__flash=0x80000000 -Wl,--defsym=__flash_size=4M
        -Wl,--defsym=__ram=0x80400000 -Wl,--defsym=__ram_size=16M)
    set_target_properties(${NAME} PROPERTIES SUFFIX .elf)
endfunction()
