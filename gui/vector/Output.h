#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace hermes::vector {

/// What a command writes. Every file is written without a name, or under a temporary one where the file
/// system knows no files without, and takes its place in commit(); when the command fails, is interrupted or
/// commit() is not reached, no trace is left; where it is killed, only a temporary name. `-` and the empty
/// path are standard output, which is not held back. Where its reader goes away early, the files are still
/// put in their places.
class OutputSet {
public:
    explicit OutputSet(bool force);
    ~OutputSet();
    OutputSet(const OutputSet &) = delete;
    OutputSet &operator=(const OutputSet &) = delete;

    /// A stream for the path. Throws Failure when the target exists (unless force), is a folder, is asked for
    /// twice or cannot be written.
    std::ostream &open(const std::string &path);
    /// nullptr for the empty path.
    std::ostream *openIfNamed(const std::string &path) { return path.empty() ? nullptr : &open(path); }
    /// Makes a folder, and those above it, where they are missing; what was made and is empty goes again
    /// unless commit() is reached. Throws Failure when it cannot be made.
    void makeFolder(const std::string &path);
    /// Puts all files in their places; throws Failure when one could not be written, and after that when
    /// standard output could not, whoever wrote to it.
    void commit();

private:
    struct File;
    struct Folder {
        std::string path;
        std::size_t place; ///< in the list of what a signal removes
    };

    bool force_, committed_ = false;
    std::vector<std::unique_ptr<File>> files_;
    std::vector<Folder> folders_; ///< a folder before what lies in it
};

} // namespace hermes::vector
