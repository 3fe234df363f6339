#pragma once

#include "common/Outcome.h"

#include <cstdio>
#include <memory>

namespace hermes {

/// A file that is written aside and takes its place when it is complete. Until then it has no name, or a
/// temporary one where the file system knows no files without: on Windows that goes with the process,
/// whatever ends it; elsewhere signals remove it (TemporaryNames.h).
class HeldFile {
public:
    /// path: in UTF-8. Its folder must be there.
    static Outcome<std::unique_ptr<HeldFile>> make(const std::string &path);
    /// Without putInPlace() nothing is left.
    virtual ~HeldFile() = default;

    /// A stream of bytes into it, to be closed before putInPlace(). Once.
    virtual std::FILE *open() = 0;
    /// Without `replace` fails where there is a file of that name.
    virtual Outcome<void> putInPlace(bool replace) = 0;

protected:
    HeldFile() = default;
    HeldFile(const HeldFile &) = delete;
    HeldFile &operator=(const HeldFile &) = delete;
};

} // namespace hermes
