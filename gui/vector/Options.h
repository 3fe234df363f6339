#pragma once

#include "gui/vector/Output.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/segmentation/EarSegmenter.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace hermes::vector {

/// Where a command's results go.
struct OutputOptions {
    std::string out;        ///< empty is standard output
    std::string svg, latex; ///< empty is no picture
    bool force = false;

    /// Adds --out, --svg and --latex (if wanted) and --force.
    void addTo(CLI::App &command, bool withPictures);
};

/// What a command writes by these options: its result, and the picture beside it as SVG, as a LaTeX document,
/// as both or not at all. What is wrong with a path is told before any work is done, see OutputSet::open().
class Outputs : public OutputSet {
public:
    explicit Outputs(const OutputOptions &options)
        : OutputSet(options.force)
        , out(open(options.out))
        , svg_(openIfNamed(options.svg))
        , latex_(openIfNamed(options.latex)) {}

    std::ostream &out;

    /// The picture is asked for where it is wanted.
    void draw(const std::function<vectorlib::SvgPicture()> &picture) const;

private:
    std::ostream *svg_, *latex_;
};

/// Adds an option with a usage as "--k N": its name, and what the help calls its value.
template <typename Value>
CLI::Option *addOption(CLI::App &command, const std::string &usage, Value &value,
                       const std::string &description) {
    const std::size_t space = usage.find(' ');
    return command.add_option(usage.substr(0, space), value, description)->type_name(usage.substr(space + 1));
}
/// The same for one whose value a validator has to let through.
template <typename Value>
CLI::Option *addOption(CLI::App &command, const std::string &usage, Value &value,
                       const CLI::Validator &validator, const std::string &description) {
    return addOption(command, usage, value, description)->transform(validator);
}

/// A finite number from low to high, both included.
CLI::Validator between(double low, double high);
/// A whole number from low to high, both included; writes it by its digits alone.
CLI::Validator wholeNumber(double low, double high);
/// A finite number above 0.
CLI::Validator aboveZero();
/// A file that a picture may go to: its name ends with the extension of its format, or has none, as `-` and
/// /dev/stdout.
CLI::Validator pictureName(const std::string &format = ".svg");
/// Three finite numbers `x,y,theta`; theta may be degrees: `90deg`. Of a sensor on a robot, no heading beyond
/// a turn and no place beyond 100 m.
CLI::Validator poseText(bool isOnRobot = false);
/// The pose in a text that poseText() has let through; metres, radians. Warns on stderr of a heading beyond a
/// full turn.
vectorlib::Pose2D parsePose(const std::string &text);

/// The options of segmentation: --k --min-threshold --max-threshold --min-points --coordinates --open.
struct SegmentOptions {
    bool open = false;

    /// defaults tells people what holds where an option is not given.
    void addTo(CLI::App &command, const std::string &defaults);
    /// The settings with what was given on top; throws CLI::ValidationError when the thresholds contradict
    /// each other.
    vectorlib::EarSettings over(vectorlib::EarSettings settings) const;

private:
    std::optional<int> neighbours_, minPoints_;
    std::optional<double> minThreshold_, maxThreshold_;
    std::string coordinates_;
};

/// The footer of a command's help: an example of its use.
std::string example(const std::string &text);

/// A new subcommand, and what it runs, for its options to set; the subcommand keeps it. usage: an example for
/// its help.
template <typename Command>
std::pair<CLI::App *, Command *> addCommand(CLI::App &app, const std::string &name, const std::string &about,
                                            const std::string &usage) {
    CLI::App *const sub = app.add_subcommand(name, about);
    const auto command = std::make_shared<Command>();
    sub->footer(example(usage));
    sub->callback([command] { command->run(); });
    return {sub, command.get()};
}

// One function a subcommand; each in a file of its own.
void addSegmentCommand(CLI::App &app);
void addVectorizeCommand(CLI::App &app);
void addRegisterCommand(CLI::App &app);
void addSimilarityCommand(CLI::App &app);
void addObserveCommand(CLI::App &app);
void addMapCommand(CLI::App &app);
void addMapMergeCommand(CLI::App &app);
void addMatchCommand(CLI::App &app);
void addRelocalizeCommand(CLI::App &app);
void addEvaluateCommand(CLI::App &app);
void addInfoCommand(CLI::App &app);
void addRingCommand(CLI::App &app);

} // namespace hermes::vector
