#pragma once

namespace hermes {

/// As long as it lives new files are their owner's alone. On Windows they have the access list of their
/// folder, and folders of a person's profile are closed to others already.
class PrivateFiles {
public:
    PrivateFiles();
    ~PrivateFiles();
    PrivateFiles(const PrivateFiles &) = delete;
    PrivateFiles &operator=(const PrivateFiles &) = delete;

private:
    unsigned before_ = 0;
};

/// Whether the permissions of a file tell who else may read it. Not on Windows, where access lists do.
bool permissionsTellReaders();

/// Brings the file behind a descriptor of the C library to the disk; false: errno tells why not.
bool syncToDisk(int descriptor);

} // namespace hermes
