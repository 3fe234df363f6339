#pragma once

#include "gui/desktop/Layouts.h"

#include <QElapsedTimer>
#include <QLockFile>
#include <QObject>
#include <QThreadPool>
#include <future>

namespace hermes::desktop {

/// Writes layouts when they have changed, in a thread of its own, for a disk may take its time. What could
/// not be written is tried again after 5 s. Of several windows with the same file the first one writes it;
/// what others have changed there is never overwritten. Its end writes what is left, and waits for it.
class LayoutKeeper : public QObject {
    Q_OBJECT
public:
    explicit LayoutKeeper(Layouts &layouts, QObject *parent = nullptr);
    ~LayoutKeeper() override;

    /// Begins to write, unless it does already.
    void keep();
    /// The same, and waits for a moment. False: it still writes.
    bool finish();
    /// Why what was set could not be written; empty: it was.
    const QString &problem() const { return problem_; }
    /// It can still be written, when another window is closed.
    bool isWaiting() const { return isWaiting_; }

Q_SIGNALS:
    void failed(const QString &problem);
    /// Whether it failed or not.
    void ended();

private:
    bool isKept() const { return layouts_.problem().isEmpty() && !layouts_.file().isEmpty(); }
    void begin();
    bool lock();
    Result<void> write(const Layouts &taken);
    void setOutcome(const Result<void> &outcome);
    bool collect(std::chrono::milliseconds timeout);

    Layouts &layouts_;
    std::future<Result<void>> writing_;
    QElapsedTimer since_; ///< it was tried
    QString problem_;
    bool isWaiting_ = false;
    QLockFile lock_;      ///< of the thread that writes, once that has begun
    QByteArray expected_; ///< fingerprint of the file; so, too
    QThreadPool pool_;
};

} // namespace hermes::desktop
