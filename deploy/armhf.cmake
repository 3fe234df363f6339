# Toolchain for Debian armhf (ARMv7 without NEON in the baseline), docs/arm.md. Needs g++-arm-linux-gnueabihf.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR armv7l)

set(HERMES_SYSROOT "$ENV{HERMES_SYSROOT}" CACHE PATH "Root folder of a Debian armhf with the packages of the build")
if(NOT EXISTS "${HERMES_SYSROOT}/usr/lib/arm-linux-gnueabihf")
    message(FATAL_ERROR "HERMES_SYSROOT is '${HERMES_SYSROOT}', expected the root folder of a Debian armhf: docs/arm.md")
endif()
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HERMES_SYSROOT)

set(CMAKE_SYSROOT "${HERMES_SYSROOT}")
set(CMAKE_C_COMPILER arm-linux-gnueabihf-gcc)
set(CMAKE_CXX_COMPILER arm-linux-gnueabihf-g++)
set(CMAKE_CXX_FLAGS_INIT -Wno-psabi) # notes of what GCC 7.1 changed
set(CMAKE_LIBRARY_ARCHITECTURE arm-linux-gnueabihf)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} "${HERMES_SYSROOT}")
set(ENV{PKG_CONFIG_LIBDIR}
    "${HERMES_SYSROOT}/usr/lib/arm-linux-gnueabihf/pkgconfig:${HERMES_SYSROOT}/usr/share/pkgconfig")
