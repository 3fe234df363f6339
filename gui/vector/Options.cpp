#include "gui/vector/Options.h"

#include "common/AngleText.h"
#include "vectorlib/io/LatexExport.h"
#include "vectorlib/io/TextInput.h"

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace hermes::vector {

namespace {

// The part of a validator that says what is wrong with a number, or nothing.
CLI::Validator numberThat(std::string expected, std::function<bool(double)> holds) {
    return CLI::Validator(
        [expected, holds](const std::string &text) {
            const auto number = vectorlib::parseNumber(text);
            return number && holds(*number) ? std::string()
                                            : "found " + vectorlib::quoted(text) + ", expected " + expected;
        },
        "", "number");
}

std::optional<vectorlib::Pose2D> readPose(const std::string &text) {
    std::vector<std::string_view> fields;
    vectorlib::splitCommas(text, fields);
    if (fields.size() != 3)
        return std::nullopt;
    const auto x = vectorlib::parseNumber(fields[0]), y = vectorlib::parseNumber(fields[1]);
    const auto theta = parseAngle(fields[2], vectorlib::parseNumber);
    return x && y && theta ? std::optional(vectorlib::Pose2D{*x, *y, *theta}) : std::nullopt;
}

std::string plain(double value) {
    std::ostringstream out;
    out << std::setprecision(12) << value;
    return out.str();
}

} // namespace

CLI::Validator between(double low, double high) {
    return numberThat("a number from " + plain(low) + " to " + plain(high),
                      [low, high](double v) { return v >= low && v <= high; });
}

CLI::Validator wholeNumber(double low, double high) {
    const std::string expected = "a whole number from " + plain(low) + " to " + plain(high);
    return CLI::Validator(
        [=](std::string &text) {
            const auto number = vectorlib::parseNumber(text);
            if (!number || *number < low || *number > high || *number != std::floor(*number))
                return "found " + vectorlib::quoted(text) + ", expected " + expected;
            text = std::to_string(static_cast<long long>(*number));
            return std::string();
        },
        "", "number");
}

CLI::Validator aboveZero() {
    return numberThat("a number above 0", [](double v) { return v > 0; });
}

CLI::Validator pictureName(const std::string &format) {
    const auto check = [format](const std::string &path) {
        const std::string extension = std::filesystem::u8path(path).extension().u8string();
        return extension.empty() || extension == format
                   ? std::string()
                   : "found " + path + ", expected a name that ends with " + format;
    };
    return {check, ""};
}

CLI::Validator poseText(bool isOnRobot) {
    constexpr double farthest_m = 100;
    return CLI::Validator(
        [isOnRobot](const std::string &text) {
            const auto pose = readPose(text);
            if (!pose)
                return "found " + vectorlib::quoted(text) +
                       ", expected three numbers x,y,theta (metres, radians or as 90deg)";
            if (isOnRobot && isBeyondTurn(pose->theta))
                return "found " + vectorlib::quoted(text) + ": " + beyondTurnText(pose->theta);
            return isOnRobot && !(std::hypot(pose->x, pose->y) <= farthest_m)
                       ? "found " + vectorlib::quoted(text) + ", expected a place on the robot, within 100 m"
                       : std::string();
        },
        "", "pose");
}

vectorlib::Pose2D parsePose(const std::string &text) {
    const vectorlib::Pose2D pose = readPose(text).value();
    if (isBeyondTurn(pose.theta))
        std::cerr << "hermes-vector: " << text << ": " << beyondTurnText(pose.theta) << '\n';
    return pose;
}

void OutputOptions::addTo(CLI::App &command, bool withPictures) {
    addOption(command, "--out FILE", out, "Write the result to this file instead of standard output");
    if (withPictures) {
        addOption(command, "--svg FILE", svg, pictureName(), "Also draw a picture");
        addOption(command, "--latex FILE", latex, pictureName(".tex"),
                  "Also write the picture as a LaTeX document");
    }
    command.add_flag("--force", force, "Overwrite files that exist");
}

void Outputs::draw(const std::function<vectorlib::SvgPicture()> &picture) const {
    if (!svg_ && !latex_)
        return;
    vectorlib::SvgPicture drawn = picture();
    if (svg_)
        drawn.write(*svg_);
    if (!latex_)
        return;
    vectorlib::LatexExport document(*latex_);
    document.picture(drawn);
    document.finish();
}

void SegmentOptions::addTo(CLI::App &command, const std::string &defaults) {
    const std::string group = "Segmentation (" + defaults + ")";
    addOption(command, "--k N", neighbours_, wholeNumber(1, 100000),
              "How many earlier points each point is compared with")
        ->group(group);
    addOption(command, "--min-threshold M", minThreshold_, aboveZero(),
              "Lower bound of the distance threshold, metres")
        ->group(group);
    addOption(command, "--max-threshold M", maxThreshold_, aboveZero(),
              "Upper bound of the distance threshold, metres")
        ->group(group);
    addOption(command, "--min-points N", minPoints_, wholeNumber(1, 1e9), "Smaller clusters are outliers")
        ->group(group);
    addOption(command, "--coordinates KIND", coordinates_, CLI::IsMember({"cartesian", "polar"}),
              "In which points are compared: cartesian, by their distance (the default), or polar, angle and "
              "range by themselves")
        ->group(group);
    command.add_flag("--open", open, "The last point is no neighbour of the first: less than a full turn")
        ->group(group);
}

vectorlib::EarSettings SegmentOptions::over(vectorlib::EarSettings settings) const {
    settings.neighbours = neighbours_.value_or(settings.neighbours);
    settings.minThreshold = minThreshold_.value_or(settings.minThreshold);
    settings.maxThreshold = maxThreshold_.value_or(settings.maxThreshold);
    settings.minPoints = minPoints_.value_or(settings.minPoints);
    if (!coordinates_.empty())
        settings.coordinates = coordinates_ == "polar" ? vectorlib::EarSettings::Coordinates::Polar
                                                       : vectorlib::EarSettings::Coordinates::Cartesian;
    if (settings.minThreshold > settings.maxThreshold)
        throw CLI::ValidationError("--min-threshold",
                                   "found a value above --max-threshold, expected at most that");
    settings.closed = settings.closed && !open;
    return settings;
}

std::string example(const std::string &text) {
    return "Example:\n  " + text +
           "\n\nIN may be gzip-compressed; - is standard input. Exit status: 0 success, 2 wrong usage, 1 any "
           "other failure.";
}

} // namespace hermes::vector
