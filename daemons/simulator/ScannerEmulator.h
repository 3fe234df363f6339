#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace hermes::simulator {

class ScannerEmulator;
struct ScannerModel;

/// Of one scanner, whatever its model.
struct ScannerOptions {
    double drift_ppm = 0; ///< how much faster its clock goes, if it has one
    std::uint64_t seed = 1;
};

/// A type of scanner that can be emulated.
struct ScannerModel {
    using Make = std::unique_ptr<ScannerEmulator> (*)(const ScannerModel &, const ScannerOptions &);

    const char *name;
    Make make;       ///< of its family
    int baud;        ///< 0: any, as over USB
    int points_hz;   ///< in all, seen or not
    double turns_hz; ///< unless it is told otherwise
    double range_m;  ///< farther things it does not see
};

/// All models.
const std::vector<ScannerModel> &scannerModels();
/// None for a name that is no model's.
std::unique_ptr<ScannerEmulator> makeScanner(std::string_view model, const ScannerOptions &options = {});

/// A laser scanner at the far end of a serial line or a network: it hears what the host sends, turns,
/// measures, and sends as fast as its line carries bytes. Knows no line and no clock. Families derive from
/// it.
class ScannerEmulator {
public:
    /// The range along a direction (radians, counter-clockwise from the scanner's zero) now, metres; 0: none.
    using Measure = std::function<double(double angle)>;
    struct Fault {
        enum class Kind {
            None,
            Silence, ///< dead
            Corrupt, ///< a share of the bytes has one bit flipped
            Loss,    ///< a share of the bytes is left out
            Stalled, ///< the head stands
            Health,  ///< it tells that it is broken, until it is reset; of those that tell
            Held,    ///< once: it scans as an earlier host left it, beginning in the middle of a packet
        };
        Kind kind = Kind::None;
        double share = 0;
    };

    ScannerEmulator(const ScannerModel &model, const ScannerOptions &options);
    virtual ~ScannerEmulator() = default;

    /// The host has sent this.
    void receive(std::string_view bytes, std::int64_t now_ns);
    /// The host has closed its connection over a network.
    void disconnect();
    /// Lets time come to now, in short steps. What has left the line since; valid until the next call.
    std::string_view take(std::int64_t now_ns, const Measure &measure);

    void setFault(const Fault &fault);
    virtual bool tellsHealth() const { return false; } ///< so that the host can ask or see it
    const ScannerModel &model() const { return model_; }
    std::uint64_t revolutions() const { return revolutions_; }

protected:
    virtual void hear(std::uint8_t byte) = 0;
    /// Whether samples are to be taken.
    virtual bool isScanning() const = 0;
    /// Takes one, with the head at turn().
    virtual void sample() = 0;
    /// Scans as an earlier host left it.
    virtual void resume() {}
    /// Nobody listens any more; of those with a network.
    virtual void hangUp() {}

    /// It leaves the line after what was sent before, not before now and some time later.
    void send(std::string_view bytes, double later_ns = 0);
    /// What has not left the line is lost.
    void unsend() { pending_.clear(); }

    void setSpeed(double turns_hz) { turns_hz_ = turns_hz; }
    double speed() const { return turns_hz_; } ///< turns a second
    bool turns() const { return turns_hz_ > 0 && fault_.kind != Fault::Kind::Stalled; }
    double turn() const { return turn_; } ///< 0 to 1, in the sense in which the head turns
    /// The step in which the head is, of so many a turn.
    unsigned stepOf(int steps) const { return unsigned(std::lround(turn_ * steps) % steps); }
    bool isFirst() const { return first_; }      ///< sample of a turn
    double period_ns() const { return period_; } ///< from sample to sample
    void setPeriod(double period_ns) { period_ = period_ns; }
    bool isBroken() const { return fault_.kind == Fault::Kind::Health; }
    void mend() { fault_.kind = isBroken() ? Fault::Kind::None : fault_.kind; }
    /// Now, by the scanner's own clock, which began some time ago.
    std::int64_t clock_us() const;
    /// Millimetres along a direction, in turns counter-clockwise from its zero; 0 where it sees nothing or
    /// what does not fit.
    int range_mm(double turns, int largest = 65535) const;

    std::string request_; ///< what has been heard of one

private:
    void begin(std::int64_t now_ns);
    bool chance(double share) { return std::uniform_real_distribution<double>()(random_) < share; }

    const ScannerModel &model_;
    ScannerOptions options_;
    std::minstd_rand random_;
    Fault fault_;
    double turns_hz_, turn_ = 0, period_;
    bool first_ = false;
    std::uint64_t revolutions_ = 0;
    const Measure *measure_ = nullptr;        ///< while samples are taken
    std::int64_t start_ns_ = 0, next_ns_ = 0; ///< next sample; start 0: none yet
    std::int64_t now_ns_ = 0;                 ///< of what is heard or sampled
    double rest_ns_ = 0;                      ///< of the next sample's time
    std::string pending_, told_;
    double lineFree_ns_ = 0; ///< after start: when the last byte has left the line
    int held_ = 0;           ///< bytes that are to be lost
};

/// A number, little endian.
std::string bytes16(unsigned value);
std::string bytes32(std::uint32_t value);
/// An answer of RPLIDAR and YDLIDAR. packetSize: of packets that follow until the next request; 0: none do.
std::string answerOf(std::uint8_t type, std::string_view bytes, std::size_t packetSize = 0);

/// The row of a family's table, whose rows begin with the name.
template <typename Type>
const Type &typeOf(const ScannerModel &model, const std::vector<Type> &types) {
    const auto isNamedSo = [&model](const Type &type) { return type.name == std::string_view(model.name); };
    return *std::find_if(types.begin(), types.end(), isNamedSo);
}

/// Makes a scanner of a family.
template <typename Family>
std::unique_ptr<ScannerEmulator> makeOf(const ScannerModel &model, const ScannerOptions &options) {
    return std::make_unique<Family>(model, options);
}
extern const ScannerModel::Make makeRplidar, makeLdrobot, makeYdlidar, makeHokuyo, makeSick;

} // namespace hermes::simulator
