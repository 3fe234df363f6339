#include "tests/support/FaultyInterface.h"

#include "common/Time.h"

#include <algorithm>
#include <cmath>

namespace hermes {

FaultyInterface::FaultyInterface(Interface *wrapped, const Faults &kinds, QObject *parent)
    : Interface(parent)
    , inner_(wrapped)
    , faults_(kinds)
    , random_(kinds.seed) {
    inner_->setParent(this);
    connect(inner_, &Interface::opened, this, &FaultyInterface::nowOpen);
    connect(inner_, &Interface::closed, this, [this](const QString &reason) { nowClosed(reason, false); });
    connect(inner_, &Interface::drained, this, &Interface::drained);
    connect(inner_, &Interface::received, this, [this](const QByteArray &bytes) {
        pass(bytes, [this](const QByteArray &piece) { nowReceived(piece); });
    });
}

bool FaultyInterface::doWrite(const QByteArray &bytes) {
    pass(bytes, [this](const QByteArray &piece) { inner_->write(piece); });
    return true;
}

bool FaultyInterface::chance(double probability) {
    return std::uniform_real_distribution<double>(0, 1)(random_) < probability;
}

void FaultyInterface::pass(QByteArray bytes, const Delivery &deliver) {
    if (chance(faults_.drop)) {
        ++faultsMade_;
        return;
    }
    if (!bytes.isEmpty() && chance(faults_.flip)) {
        ++faultsMade_;
        const auto bit = std::uniform_int_distribution<int>(0, bytes.size() * 8 - 1)(random_);
        bytes[bit / 8] = char(bytes[bit / 8] ^ (1 << bit % 8));
    }
    if (bytes.size() > 1 && chance(faults_.split)) {
        const auto cut = std::uniform_int_distribution<int>(1, bytes.size() - 1)(random_);
        later(bytes.left(cut), deliver);
        bytes = bytes.mid(cut);
    }
    later(bytes, deliver);
}

void FaultyInterface::later(const QByteArray &bytes, const Delivery &deliver) {
    const double now = monotonicNow();
    const double delay = std::uniform_int_distribution<int>(0, faults_.longestDelay_ms)(random_) / 1000.0;
    lastDue_ = std::max(lastDue_, now + delay);
    const int wait_ms = int(std::ceil((lastDue_ - now) * 1000));
    waiting_.emplace_back(bytes, deliver);
    QTimer::singleShot(wait_ms, Qt::PreciseTimer, this, [this] { // timers of one instant fire in any order
        const auto [piece, target] = std::move(waiting_.front());
        waiting_.pop_front();
        target(piece);
    });
}

} // namespace hermes
