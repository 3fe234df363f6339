#pragma once

#include <QByteArray>
#include <QFile>
#include <QString>
#include <QThreadPool>
#include <mutex>

namespace hermes::softwaretrigger {

/// CSV files of rows in a folder, written by a thread of its own, each row given to the system at once. A
/// file is never overwritten; a new one begins at each start and when the size is reached. Rows that cannot
/// be written (a full disk), or that come while 1000 wait, are counted; a row is in the file whole or not at
/// all.
class FiringLog {
public:
    /// header and rows end in a line feed. No folder: nothing is written.
    FiringLog(QString folder, double fileBytes, QByteArray header);
    /// Waits until everything is written.
    ~FiringLog();

    void append(const QByteArray &row);
    /// Waits until everything is written. For tests and the end.
    void flush() { disk_.waitForDone(); }

    struct State {
        QString folder, path;
        quint64 rows = 0, lost = 0;
        QString error; ///< empty when the last row was written
    };
    State state() const;

private:
    void write(const QByteArray &row);
    QString begin();
    bool isRemoved() const;

    const double fileBytes_;
    const QByteArray header_;
    QFile file_; // of the thread

    mutable std::mutex mutex_; // of what follows
    int waiting_ = 0;
    State state_;

    QThreadPool disk_; // one thread: rows are written one after another
};

/// A field of a CSV row: quoted where it must be.
QByteArray csvField(const QString &text);

} // namespace hermes::softwaretrigger
