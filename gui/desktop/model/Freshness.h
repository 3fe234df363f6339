#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <algorithm>

namespace hermes::desktop {

/// How old a value is that is shown: fresh; old when half a second, or three times the time that lay between
/// the last two, has passed; silent 2.5 s later. What is old is grey, what is silent is struck out and said
/// to be without data: nothing that came from a robot looks live for longer than it is.
class Freshness {
public:
    enum class State { None, Fresh, Old, Silent }; ///< None: nothing has come as yet

    /// A value came.
    void heard() {
        if (last_.isValid())
            period_s_ = std::min(age_s(), longestPeriod_s);
        last_.start();
    }
    void forget() { *this = {}; }

    double age_s() const { return last_.isValid() ? 1e-3 * double(last_.elapsed()) : 0; }
    State state() const {
        if (!last_.isValid())
            return State::None;
        const double old_s = std::max(0.5, 3 * period_s_), age = age_s();
        return age < old_s ? State::Fresh : age < old_s + 2.5 ? State::Old : State::Silent;
    }
    bool isFresh() const { return state() == State::Fresh; }
    /// "no data for 3 s" when it is silent, else empty.
    QString text() const {
        return state() == State::Silent ? QObject::tr("no data for %1 s").arg(int(age_s())) : QString();
    }

private:
    static constexpr double longestPeriod_s = 1;

    QElapsedTimer last_;
    double period_s_ = 0;
};

} // namespace hermes::desktop
