#include "daemons/simulator/PathFollower.h"

#include <algorithm>
#include <cmath>

namespace hermes {

namespace {

constexpr double arrival = 1e-6; // seconds at full speed: a micrometre at 1 m/s

} // namespace

PathFollower::PathFollower(PosePath path, double acceleration)
    : m_path(std::move(path))
    , m_acceleration(acceleration) {}

void PathFollower::restart() {
    m_progress = m_rate = 0;
}

void PathFollower::advance(double seconds) {
    if (!m_driving && m_rate == 0)
        return;
    const double rest = m_path.length() - m_progress;
    const double change = m_acceleration * seconds;
    // The rate from which it can still come to rest where the path ends.
    const double brake = std::sqrt(2 * m_acceleration * std::max(0.0, rest));
    m_rate = m_driving ? std::min({1.0, m_rate + change, brake}) : std::max(0.0, m_rate - change);
    m_progress += m_rate * seconds;
    if (m_path.length() - m_progress > arrival)
        return;
    m_progress = m_path.length();
    m_rate = 0;
    m_driving = false;
}

} // namespace hermes
