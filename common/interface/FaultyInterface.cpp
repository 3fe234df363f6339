#include "common/interface/FaultyInterface.h"

#include "common/Time.h"

#include <algorithm>
#include <cmath>

namespace hermes {

FaultyInterface::FaultyInterface(Interface *wrapped, const Faults &kinds, QObject *parent)
    : Interface(parent)
    , inner(wrapped)
    , faults(kinds)
    , random(kinds.seed) {
    inner->setParent(this);
    connect(inner, &Interface::opened, this, &FaultyInterface::nowOpen);
    connect(inner, &Interface::closed, this, [this](const QString &reason) { nowClosed(reason, false); });
    connect(inner, &Interface::drained, this, &Interface::drained);
    connect(inner, &Interface::received, this, [this](const QByteArray &bytes) {
        pass(bytes, [this](const QByteArray &piece) { nowReceived(piece); });
    });
}

bool FaultyInterface::doWrite(const QByteArray &bytes) {
    pass(bytes, [this](const QByteArray &piece) { inner->write(piece); });
    return true;
}

bool FaultyInterface::chance(double probability) {
    return std::uniform_real_distribution<double>(0, 1)(random) < probability;
}

void FaultyInterface::pass(QByteArray bytes, const Delivery &deliver) {
    if (chance(faults.drop)) {
        ++faultsMade;
        return;
    }
    if (!bytes.isEmpty() && chance(faults.flip)) {
        ++faultsMade;
        const auto bit = std::uniform_int_distribution<int>(0, bytes.size() * 8 - 1)(random);
        bytes[bit / 8] = char(bytes[bit / 8] ^ (1 << bit % 8));
    }
    if (bytes.size() > 1 && chance(faults.split)) {
        const auto cut = std::uniform_int_distribution<int>(1, bytes.size() - 1)(random);
        later(bytes.left(cut), deliver);
        bytes = bytes.mid(cut);
    }
    later(bytes, deliver);
}

void FaultyInterface::later(const QByteArray &bytes, const Delivery &deliver) {
    const double now = monotonicNow();
    const double delay = std::uniform_int_distribution<int>(0, faults.longestDelay_ms)(random) / 1000.0;
    lastDue = std::max(lastDue, now + delay);
    const int wait_ms = int(std::ceil((lastDue - now) * 1000));
    waiting.emplace_back(bytes, deliver);
    QTimer::singleShot(wait_ms, Qt::PreciseTimer, this, [this] { // timers of one instant fire in any order
        const auto [piece, target] = std::move(waiting.front());
        waiting.pop_front();
        target(piece);
    });
}

} // namespace hermes
