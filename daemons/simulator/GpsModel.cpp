#include "daemons/simulator/GpsModel.h"

#include "vectorlib/geometry/Angle.h"

#include <cmath>

namespace hermes::simulator {

namespace {

constexpr double perDegree = vectorlib::pi / 180; // radians
constexpr std::int64_t second_ns = 1000000000;
// WGS 84
constexpr double equator = 6378137, eccentricity2 = 6.69437999014e-3;
// Made up: a good view of the sky.
constexpr int satellites = 9;
constexpr double dilution = 0.9;
constexpr double slowest = 0.02; // m/s; below it the course is the robot's heading
constexpr nmea::Decimals onTheLine{6, 2};

} // namespace

std::int64_t GpsModel::timeOfFix(std::int64_t number) const {
    return number / options_.rate_hz * second_ns + number % options_.rate_hz * second_ns / options_.rate_hz;
}

std::string_view GpsModel::take(std::int64_t now_ns, const Pose2D &pose, const Twist2D &twist) {
    told_.clear();
    if (now_ns >= due_ns_) {
        std::swap(told_, pending_);
        if (!pendingLidar_.empty())
            lidarSentence_ = pendingLidar_;
        due_ns_ = never;
    }
    if (now_ns < nextFix_ns_)
        return told_;
    if (nextFix_ns_ > 0 && now_ns < timeOfFix(number_ + 1) && fault_.kind != Fault::Kind::Silence)
        fix(nextFix_ns_, pose, twist);
    // The first one after the start, and after a time that was left out, is on the grid again.
    number_ = now_ns / second_ns * options_.rate_hz;
    while (timeOfFix(number_) <= now_ns)
        ++number_;
    nextFix_ns_ = timeOfFix(number_);
    return told_;
}

nmea::Position GpsModel::positionOf(double east, double north) const {
    const double latitude = options_.origin.latitude_deg * perDegree;
    const double w = std::sqrt(1 - eccentricity2 * std::sin(latitude) * std::sin(latitude));
    const double meridian = equator * (1 - eccentricity2) / (w * w * w) + options_.altitude;
    const double parallel = (equator / w + options_.altitude) * std::cos(latitude);
    return {options_.origin.latitude_deg + north / meridian / perDegree,
            std::remainder(options_.origin.longitude_deg + east / parallel / perDegree, 360)};
}

void GpsModel::fix(std::int64_t time_ns, const Pose2D &pose, const Twist2D &twist) {
    const double stamp = double(time_ns) * 1e-9;
    nmea::Rmc rmc;
    nmea::Gga gga;
    rmc.time = gga.time = nmea::timeOf(stamp);
    rmc.date = nmea::dateOf(stamp);
    rmc.valid = fault_.kind != Fault::Kind::NoFix;
    rmc.mode = rmc.valid ? 'A' : 'N';
    gga.satellites = rmc.valid ? satellites : 0;
    if (rmc.valid) {
        const double east = pose.x + options_.sigma * normal_(random_);
        const double north = pose.y + options_.sigma * normal_(random_);
        rmc.position = gga.position = positionOf(east, north);
        rmc.speed = std::hypot(twist.vx, twist.vy);
        const double direction =
            pose.theta + (*rmc.speed > slowest ? std::atan2(twist.vy, twist.vx) : 0); // from east
        const double course = std::remainder(90 - direction / perDegree, 360);
        rmc.course_deg = course < 0 ? course + 360 : course;
        gga.quality = 1;
        gga.hdop = dilution;
        gga.altitude = options_.altitude + options_.sigma * normal_(random_);
    }
    pending_.clear();
    tell(encode(rmc, "GP", onTheLine));
    tell(encode(gga, "GP", onTheLine));
    pendingLidar_.clear();
    if (const auto sentence = encode(rmc); sentence && time_ns % second_ns == 0)
        pendingLidar_ = sentence->view().substr(0, sentence->view().size() - 2);
    due_ns_ = time_ns + delay_ns;
}

void GpsModel::tell(const std::optional<nmea::SentenceText> &sentence) {
    if (!sentence)
        return;
    pending_ += sentence->view();
    if (fault_.kind != Fault::Kind::Corrupt ||
        std::uniform_real_distribution<double>()(random_) >= fault_.share)
        return;
    const std::size_t size = sentence->view().size() - 2; // the line end stays
    char &byte = pending_[pending_.size() - 2 - size + random_() % size];
    byte = char(byte ^ (1 << random_() % 7)); // it stays a text
}

} // namespace hermes::simulator
