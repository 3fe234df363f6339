#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace hermes::vector {

/// What a command writes. Every file is written under a temporary name beside its target and takes its place
/// in commit(); when the command fails, is interrupted or commit() is not reached, no trace is left. `-` and
/// the empty path are standard output, which is not held back.
class OutputSet {
public:
    explicit OutputSet(bool force);
    ~OutputSet();
    OutputSet(const OutputSet &) = delete;
    OutputSet &operator=(const OutputSet &) = delete;

    /// A stream for the path. Throws Failure when the target exists (unless force), is a folder, is asked for
    /// twice or cannot be written.
    std::ostream &open(const std::string &path);
    /// Puts all files in their places; throws Failure when something could not be written.
    void commit();

private:
    struct File;
    bool force_;
    std::vector<std::unique_ptr<File>> files_;
};

/// Makes the program remove its temporary files when a signal ends it.
void removeTemporariesOnSignal();

} // namespace hermes::vector
