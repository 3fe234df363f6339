# Builds the daemon of the page in C++, of the libraries that the tested build has: bin/hermes-fastlaser.
mkdir extension
{ echo 'set(CMAKE_AUTOMOC OFF)'; cat docs/examples/fastlaser/CMakeLists.txt; } >extension/CMakeLists.txt
cp docs/examples/fastlaser/main.cpp extension
PYTHONPATH=tests/system:tests/support python3 -c 'import extensions, os
extensions.configure(os.path.abspath("extension"), os.path.abspath("own"))
extensions.link(os.path.abspath("own"), "bin/hermes-fastlaser")' >own.log 2>&1 || { cat own.log; false; }
PATH=$PWD/own/bin:$PATH
