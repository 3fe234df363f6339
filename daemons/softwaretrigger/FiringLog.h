#pragma once

#include <QByteArray>
#include <QFile>
#include <QString>
#include <QThreadPool>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <vector>

namespace hermes::softwaretrigger {

/// How late firings were.
struct Jitter {
    int count = 0;
    std::optional<double> mean_s, p99_s, worst_s; ///< of some
};

/// How late the last 1000 firings were.
class JitterWindow {
public:
    void add(double late_s) {
        if (values_.size() < size)
            values_.push_back(late_s);
        else
            values_[next_] = late_s;
        next_ = (next_ + 1) % size;
    }

    Jitter summary() const {
        if (values_.empty())
            return {};
        std::vector<double> sorted = values_;
        std::sort(sorted.begin(), sorted.end());
        const auto p99 = std::size_t(std::ceil(0.99 * double(sorted.size()))) - 1;
        return {int(sorted.size()),
                std::accumulate(sorted.begin(), sorted.end(), 0.0) / double(sorted.size()), sorted[p99],
                sorted.back()};
    }

private:
    static constexpr std::size_t size = 1000;
    std::vector<double> values_;
    std::size_t next_ = 0;
};

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
    State state() const {
        const std::lock_guard lock(mutex_);
        return state_;
    }

private:
    void write(const QByteArray &row);
    QString begin();
    // Somebody has removed it, or its folder: rows in it would be lost.
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
