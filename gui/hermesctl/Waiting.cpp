#include "gui/hermesctl/Waiting.h"

#include <algorithm>

namespace hermes::ctl {

int Waiting::count = 0;

Waiting::Waiting(std::chrono::milliseconds most)
    : Waiting(most, most.count() > 0 ? "waiting at most, second" : "waiting, second") {
    if (Progress::isJson())
        timer_.stop();
}

Waiting::Waiting(std::chrono::milliseconds most, const char *what)
    : progress_(what) {
    if (count++ > 0)
        return;
    since_.start();
    QObject::connect(&timer_, &QTimer::timeout, [this, most] {
        const qint64 passed =
            most.count() > 0 ? std::min<qint64>(since_.elapsed(), most.count()) : since_.elapsed();
        progress_.update(double(passed) / 1000, double(most.count()) / 1000);
    });
    timer_.start(100);
}

Waiting::~Waiting() {
    --count;
}

} // namespace hermes::ctl
