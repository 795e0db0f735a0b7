# roadpose_board(NAME LIBRARY_RAM_BYTES): start-up, memory layout and semihosting of the MPS2 boards. The toolchain file
# says which: ROADPOSE_BOARD_MEMORY.
function(roadpose_board NAME LIBRARY_RAM_BYTES)
    set(FOLDER ${PROJECT_SOURCE_DIR}/port/cortex_m)
    target_sources(${NAME} PRIVATE ${FOLDER}/startup.c ${FOLDER}/board.c command_line.c library_stack.c)
    # Where gcc's own <stdint.h> comes before the C library's, as in Debian, its <inttypes.h> needs to be told.
    target_compile_definitions(${NAME} PRIVATE ROADPOSE_BOARD_SECTIONS __int64_t_defined=1)
    target_link_options(${NAME} PRIVATE --specs=rdimon.specs -nostartfiles -Wl,--gc-sections -L${FOLDER}
        -T${ROADPOSE_BOARD_MEMORY} -Wl,--defsym=library_ram_bytes=${LIBRARY_RAM_BYTES} -Wl,-Map=${NAME}.map)
    set_target_properties(${NAME} PROPERTIES SUFFIX .elf LINK_DEPENDS "${FOLDER}/${ROADPOSE_BOARD_MEMORY};${FOLDER}/sections.ld")
endfunction()
