# The host's processor in its 32-bit mode. Debian's gcc-12-multilib alone leaves the kernel's headers where only the 64-bit
# compiler looks; gcc-multilib, which has a link to them, excludes the cross compilers.
set(CMAKE_C_FLAGS_INIT "-m32 -idirafter /usr/include/x86_64-linux-gnu")
