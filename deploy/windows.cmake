# Toolchain of the preset windows: Debian's MinGW-w64 for 64-bit Windows, one .exe without libraries of its own (docs/windows.md).
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix) # -posix: with std::thread
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(ZLIB_USE_STATIC_LIBS ON)
set(ZLIB_LIBRARY /usr/x86_64-w64-mingw32/lib/libz.a)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)

# Libraries that are headers only are those of this machine. Links to them alone: beside them in /usr/include stand the headers
# of its own C library.
set(headers "${CMAKE_BINARY_DIR}/headers")
file(MAKE_DIRECTORY "${headers}/include" "${headers}/share")
foreach(name CLI nlohmann eigen3)
    file(CREATE_LINK /usr/include/${name} "${headers}/include/${name}" SYMBOLIC)
endforeach()
foreach(name cmake eigen3)
    file(CREATE_LINK /usr/share/${name} "${headers}/share/${name}" SYMBOLIC)
endforeach()
list(APPEND CMAKE_PREFIX_PATH "${headers}")
list(APPEND CMAKE_FIND_ROOT_PATH "${headers}")
