#pragma once

#include "common/Result.h"

#include <QByteArray>
#include <QSet>
#include <QStringList>
#include <deque>
#include <string>

namespace hermes::recorder {

/// A file that takes the place of the one before when finish() and commit() succeed. It is open only while a
/// piece of it is written: there may be one for each topic.
class ExportFile {
public:
    ExportFile(const QString &folder, const QString &name);
    ~ExportFile();
    ExportFile(const ExportFile &) = delete;
    ExportFile &operator=(const ExportFile &) = delete;

    void write(const QByteArray &bytes) {
        waiting_ += bytes;
        if (waiting_.size() >= pieceBytes)
            flush(false);
    }
    /// For who writes it otherwise: the file that gets the name at the end.
    std::string draft() const;
    void fail(const std::string &why) { done_ = failure(QString::fromStdString(why)); }
    Result<void> finish() {
        flush(true);
        return done_;
    }
    Result<QString> commit() const;

private:
    static constexpr int pieceBytes = 1 << 16;

    void flush(bool toDisk);
    Error failure(const QString &why) const;

    const QString path_, draft_;
    QByteArray waiting_;
    Result<void> done_;
};

/// The files of one export.
class ExportFiles {
public:
    explicit ExportFiles(const QString &folder)
        : folder_(folder) {}

    /// Error: InputOutput, the folder cannot be made, or is a link.
    Result<void> begin() const;
    /// name: of a topic, or a session. Whether it can be written finish() tells.
    ExportFile &open(QString name, const QString &extension);
    /// All is on the disk, and nothing replaced as yet.
    Result<void> finish();
    Result<QStringList> commit() const;

private:
    static constexpr int longestName = 150;

    const QString folder_;
    QSet<QString> names_; ///< in small letters: some disks know no others
    std::deque<ExportFile> files_;
};

} // namespace hermes::recorder
