#pragma once

#include "tests/support/ThreadTime.h"

#include <QApplication>
#include <QEvent>

namespace hermes {

/// An application that counts events that take over 50 ms, and remembers which took longest and whom it was
/// for. It counts the windows, menus and dialogs that were shown, too.
class WatchedApplication : public QApplication {
public:
    using QApplication::QApplication;
    bool notify(QObject *receiver, QEvent *event) override {
        const bool isWindow = receiver->isWidgetType() && static_cast<QWidget *>(receiver)->isWindow();
        shown += isWindow && event->type() == QEvent::Show;
        if (depth_ > 0)
            return QApplication::notify(receiver, event);
        const QByteArray name = QByteArray(receiver->metaObject()->className()) + ' ' +
                                receiver->objectName().toUtf8() + ", event " +
                                QByteArray::number(event->type()); // it may be gone afterwards
        auto time = runningTimer();
        const double before_ms = threadTime_ms();
        ++depth_;
        const bool done = QApplication::notify(receiver, event);
        --depth_;
        const double ms = double(time.nsecsElapsed()) * 1e-6;
        over50 += ms > 50;
        over50Cpu += threadTime_ms() - before_ms > 50;
        if (ms > longest_ms) {
            longest_ms = ms;
            longest = name;
        }
        return done;
    }

    double longest_ms = 0;
    QByteArray longest;
    int over50 = 0, over50Cpu = 0; // events: on the clock, of the processor
    int shown = 0;

private:
    int depth_ = 0;
};

} // namespace hermes
