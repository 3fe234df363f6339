#pragma once

#include <QByteArray>
#include <QString>
#include <memory>

namespace hermes {

/// Lines appended to a file that rotates, by a thread of its own: a disk that stands still holds up nobody.
/// Programs that write to the same file do not disturb each other.
class AuditFile {
public:
    struct State {
        quint64 written = 0;
        quint64 lost = 0;     ///< no room in the queue, or not written
        QString problem;      ///< why the last one was lost
        double lostAt = -1e9; ///< when; of monotonicNow()
    };
    static constexpr std::size_t maxWaiting = 1000;

    /// NAME.jsonl in the folder, which is made; when it has grown to so many bytes it becomes NAME.1.jsonl,
    /// that NAME.2.jsonl, up to so many files in all.
    AuditFile(const QString &folder, const QString &name, qint64 bytes, int files);
    /// Waits a second for what waits, not longer.
    ~AuditFile();
    AuditFile(const AuditFile &) = delete;
    AuditFile &operator=(const AuditFile &) = delete;

    /// Without its line feed.
    void append(const QByteArray &line);
    State state() const;
    /// More waits for the disk than half of what can.
    bool isSlow() const;
    QString path() const;

private:
    struct Shared;

    const std::shared_ptr<Shared> shared_; // of the thread, too, which a dead disk may hold for ever
};

} // namespace hermes
