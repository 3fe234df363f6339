#include "gui/vector/Failure.h"
#include "gui/vector/LidarCapture.h"
#include "gui/vector/Options.h"
#include "gui/vector/RecordedSession.h"
#include "vectorlib/io/Number.h"

#include <iostream>

namespace hermes::vector {

namespace {

using vectorlib::Number;

// Seconds with all nine decimals: as a double they would lose the last two.
void writeSeconds(std::ostream &out, std::int64_t ns) {
    const bool negative = ns < 0;
    const std::string digits = std::to_string(negative ? -ns : ns);
    const std::string padded = digits.size() < 10 ? std::string(10 - digits.size(), '0') + digits : digits;
    out << (negative ? "-" : "") << padded.substr(0, padded.size() - 9) << '.'
        << padded.substr(padded.size() - 9);
}

struct RingCommand {
    std::string in;
    SensorOptions sensor;
    int laser = velodyne::PacketDecoder::levelLaser;
    std::string model = "auto";
    std::int64_t turn = -1; ///< -1: every turn
    std::string returns = "strongest";
    bool all = false;
    bool noVerticalOffsets = false;
    OutputOptions output;

    void run() const {
        Outputs files(output);
        std::error_code ignored;
        Input input(std::filesystem::is_directory(std::filesystem::u8path(in), ignored)
                        ? captureIn(in).value_or(in)
                        : in);
        LidarCapture capture(input, sensor, velodyne::modelFromText(model));
        velodyne::TurnAssembler::Options options;
        options.laser = all ? velodyne::PacketDecoder::allLasers : laser;
        options.model = velodyne::modelFromText(model);
        options.returns = velodyne::returnsFromText(returns);
        options.verticalOffsets = !noVerticalOffsets;
        std::uint64_t turns = 0;
        velodyne::TurnAssembler assembler(options, [&](const velodyne::Turn &t) {
            ++turns;
            if (turn < 0 || std::uint64_t(turn) == t.number)
                write(files.out, t);
            if (!files.out)
                files.commit(); // tells what is wrong; the rest of the capture need not be read
        });
        files.out << (all ? "turn,stamp,laser,azimuth,range,intensity,x,y,z\n"
                          : "turn,stamp,azimuth,range,intensity,x,y\n");
        const std::string otherSensors = capture.read(assembler);
        if (!otherSensors.empty())
            std::cerr << "hermes-vector: " << otherSensors << '\n';
        report(assembler, turns);
        files.commit();
    }

    void report(const velodyne::TurnAssembler &assembler, std::uint64_t turns) const {
        const velodyne::PacketCounts &counts = assembler.counts();
        if (laser >= assembler.model()->lasers)
            throw Failure(in + ": found a " + assembler.model()->name + ", expected a laser from 0 to " +
                          std::to_string(assembler.model()->lasers - 1) + " for --laser, not " +
                          std::to_string(laser));
        if (turn >= 0 && std::uint64_t(turn) >= turns)
            throw Failure(in + ": found " + std::to_string(turns) + " turns, expected a turn " +
                          std::to_string(turn) + " (they count from 0)");
        const std::uint64_t refused =
            counts.wrongSize + counts.wrongFlag + counts.wrongValue + counts.otherModel;
        if (refused + counts.outOfOrder + counts.lost > 0)
            std::cerr << "hermes-vector: " << counts.packets << " packets, of them " << refused
                      << " refused, " << counts.outOfOrder << " out of order; about " << counts.lost
                      << " lost\n";
    }

    void write(std::ostream &out, const velodyne::Turn &t) const {
        for (const velodyne::Point &p : t.points) {
            out << t.number << ',';
            writeSeconds(out, p.stamp_ns);
            if (all)
                out << ',' << int(p.laser);
            out << ',' << Number(p.azimuth) << ',' << Number(p.range) << ',' << int(p.intensity) << ','
                << Number(p.x) << ',' << Number(p.y);
            if (all)
                out << ',' << Number(p.z);
            out << '\n';
        }
    }
};

} // namespace

void addRingCommand(CLI::App &app) {
    const auto [sub, command] =
        addCommand<RingCommand>(app, "ring",
                                "Decode one horizontal ring a turn from a capture of an " +
                                    velodyne::sensorNames() + " (CSV turn,stamp,azimuth,range,intensity,x,y)",
                                "hermes-vector ring drive.pcap --turn 3 --out ring.csv");
    sub->add_option("PCAP", command->in,
                    "Capture, pcap or pcapng; of a recording NAME-0001.pcap, NAME-0002.pcap ... its "
                    "first file, or its folder")
        ->required();
    command->sensor.addTo(*sub);
    CLI::Option *laser = addOption(
        *sub, "--laser ID", command->laser, wholeNumber(0, velodyne::maxLasers() - 1),
        "Which laser, else the one that looks nearest to the horizon (" + velodyne::horizonLasers() + ")");
    addOption(*sub, "--model MODEL", command->model, CLI::IsMember(velodyne::modelChoices()),
              "The sensor, or auto: as the packets say (hdl32e where they do not)")
        ->capture_default_str();
    addOption(*sub, "--returns RETURNS", command->returns, CLI::IsMember({"strongest", "last", "both"}),
              "Of a sensor in dual return mode: strongest, last, or both where they differ")
        ->capture_default_str();
    addOption(*sub, "--turn N", command->turn, wholeNumber(0, 1e9),
              "This turn only, from 0; the first and the last may be partial");
    CLI::Option *all =
        sub->add_flag("--all", command->all, "Every laser; adds the columns laser and z")->excludes(laser);
    sub->add_flag("--no-vertical-offsets", command->noVerticalOffsets,
                  "Of z leave out the lasers' own heights above the sensor's origin")
        ->needs(all);
    command->output.addTo(*sub, false);
}

} // namespace hermes::vector
