#pragma once

#include "gui/desktop/model/DaemonLink.h"

#include <QElapsedTimer>
#include <QPointer>
#include <algorithm>
#include <array>

namespace hermes::desktop {

/// How old a value is that is shown: fresh; old when half a second, or three times the middle one of the last
/// three times between two, has passed, or its daemon answers nothing else either; silent 2.5 s later. What
/// is old is grey, what is silent is struck out and said to be without data: nothing that came from a robot
/// looks live for longer than it is.
class Freshness {
public:
    enum class State { None, Fresh, Old, Silent }; ///< None: nothing has come as yet

    /// A value came, from this daemon.
    void heard(const DaemonLink *teller) {
        teller_ = teller;
        if (last_.isValid())
            gaps_s_ = {gaps_s_[1], gaps_s_[2], std::min(age_s(), longestPeriod_s)};
        last_.start();
    }
    void forget() { *this = {}; }

    double age_s() const { return last_.isValid() ? 1e-3 * double(last_.elapsed()) : 0; }
    State state() const {
        if (!last_.isValid())
            return State::None;
        const bool isMute = teller_ && teller_->isSilent();
        const double old_s = isMute ? 0.5 : std::max(0.5, 3 * period_s()), age = age_s();
        return age < old_s ? State::Fresh : age < old_s + 2.5 ? State::Old : State::Silent;
    }
    bool isFresh() const { return state() == State::Fresh; }
    /// "no data for 3 s" when it is silent, else empty.
    QString text() const {
        return state() == State::Silent ? QObject::tr("no data for %1 s").arg(int(age_s())) : QString();
    }

private:
    static constexpr double longestPeriod_s = 1;

    // One that came late, as after a stall, is not its period.
    double period_s() const {
        const auto [a, b, c] = gaps_s_;
        return a > 0 ? std::max(std::min(a, b), std::min(std::max(a, b), c)) : std::max(b, c);
    }

    QPointer<const DaemonLink> teller_;
    QElapsedTimer last_;
    std::array<double, 3> gaps_s_{}; // before the latest values
};

} // namespace hermes::desktop
