#pragma once

#include <QObject>
#include <QTimer>

namespace hermes {

/// Notices gaps in the work of its thread: the process was stopped and continued, the machine slept, a call
/// took too long. What was received before the end of that is old, whenever it is read.
class GapWatch : public QObject {
    Q_OBJECT
public:
    explicit GapWatch(QObject *parent);

    /// Gaps longer than this count; 0: none.
    void watch(double seconds);
    /// To be called before what was received is acted upon: the sockets may be served before every timer.
    void look();

    quint64 count() const { return number_; }
    /// Since the end of the last one; seconds.
    double sinceLast() const;
    /// "this program stood still for 3.2 s"
    const QString &text() const { return words_; }

Q_SIGNALS:
    void ended(const QString &text);
    /// Several times within the seconds of watch().
    void looked();

private:
    double longest_ = 0;
    double last_ = 0;  // look; by the clock that goes on while the machine sleeps
    double until_ = 0; // the end of the last one
    quint64 number_ = 0;
    QString words_;
    QTimer pulse_;
};

} // namespace hermes
