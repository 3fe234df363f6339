#include "daemons/softwaretrigger/Pulses.h"

#include <QTimer>
#include <cmath>

namespace hermes::softwaretrigger {

void Pulses::start(const QString &line, double length_s, const Set &set, const Done &done) {
    if (active_.contains(line))
        return done(Error(ErrorCode::NotReady, line + ": a pulse is under way"));
    const auto on = set(true);
    if (!on)
        return done(on.error());
    active_.insert(line);
    QTimer::singleShot(std::chrono::milliseconds(qint64(std::ceil(length_s * 1000))), Qt::PreciseTimer, this,
                       [this, line, set, done] {
                           active_.remove(line);
                           const auto off = set(false);
                           done(off ? Result<QJsonValue>(QJsonValue()) : Result<QJsonValue>(off.error()));
                       });
}

} // namespace hermes::softwaretrigger
