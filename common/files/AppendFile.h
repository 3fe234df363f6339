#pragma once

#include <QString>

namespace hermes {

/// A file that only grows, written without buffers of its own, so that what was written survives the end
/// of the process. Blocks.
class AppendFile {
public:
    AppendFile() = default;
    ~AppendFile() { close(); }
    AppendFile(const AppendFile &) = delete;
    AppendFile &operator=(const AppendFile &) = delete;

    /// Fails on an existing file, with errno EEXIST.
    bool create(const QString &path);
    /// Goes on behind what is in it; makes it where there is none. Fails on a link, on what is no file, and
    /// on a file that has a second name.
    bool resume(const QString &path);
    /// False when not all of it could be written; size() tells how much was.
    bool append(const void *bytes, std::size_t size);
    bool truncate(quint64 size);
    /// Everything that was written is on the disk.
    bool sync();
    /// Its name is gone: nobody can find any more what is written.
    bool isRemoved() const;
    /// The same, or it was moved away, or another program has written to it or cut it.
    bool isChanged() const;
    void close();

    bool isOpen() const { return file_ >= 0; }
    quint64 size() const { return size_; }
    const QString &path() const { return path_; }
    /// What failed last, naming the file.
    const QString &error() const { return error_; }

private:
    bool open(const QString &path, int flags);
    bool fail(const char *what);
    bool isAtPath() const;

    QString path_, error_;
    int file_ = -1;
    bool isNamed_ = false; // its path led to it at first: not all file systems tell
    quint64 size_ = 0;
};

} // namespace hermes
