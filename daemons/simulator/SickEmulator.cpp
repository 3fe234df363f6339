#include "daemons/simulator/SectorScanner.h"

#include <iterator>
#include <sstream>
#include <utility>

namespace hermes::simulator {

namespace {

using Words = std::vector<std::string>;

struct Sick {
    const char *name;
    int values, angleStep; ///< 1/10000 degree
};

const std::vector<Sick> sicks{
    {"sick-tim551", 271, 10000}, {"sick-tim571", 811, 3333}, {"sick-lms111", 541, 5000}};
constexpr char textBegin = 2, textEnd = 3;
constexpr std::size_t longestText = 256;
constexpr int firstAngle = -450000, lastAngle = 2250000; // 1/10000 degree; 900000 is ahead
constexpr int leastRange_mm = 16, nothing = 2;           // what is less is a code
constexpr int valueIntensity = 200;

constexpr auto accessDenied = "sFA 1", unknownMethod = "sFA 2", unknownVariable = "sFA 3",
               invalidData = "sFA 5", writeDenied = "sFA A", unknownCommand = "sFA C", unknownEvent = "sFA F";

/// In 32 bits.
std::string hex(std::int64_t number) {
    std::ostringstream text;
    text << std::hex << std::uppercase << std::uint32_t(number);
    return text.str();
}

/// One with a sign is decimal.
long numberOf(const std::string &text) {
    return std::strtol(text.c_str(), nullptr, text[0] == '+' || text[0] == '-' ? 10 : 16);
}

/// CoLa A: a device that is asked, and then sends a telegram each turn.
class SickEmulator : public SectorScanner {
public:
    SickEmulator(const ScannerModel &model, const ScannerOptions &options)
        : SectorScanner(model, options)
        , type_(typeOf(model, sicks)) {
        setSector(first_, last_);
    }

    bool tellsHealth() const override { return true; }

protected:
    void hear(std::uint8_t byte) override;
    bool isScanning() const override { return (sends_ || asked_) && measures_ && turns(); }
    void pass(int step) override;
    void resume() override { sends_ = true; }
    void hangUp() override { sends_ = asked_ = loggedIn_ = false; }

private:
    void tell(const std::string &text) { send(textBegin + text + textEnd); }
    std::string answer(const Words &words);
    std::string read(const std::string &variable);
    std::string write(const std::string &variable, const Words &words);
    std::string call(const std::string &method, const Words &words);
    std::string channel(const char *name, bool intensity) const;
    std::string telegram();

    const Sick &type_;
    const int first_ = steps() / 8, last_ = first_ + type_.values - 1; ///< steps; the rear is at -90 degrees
    bool loggedIn_ = false, measures_ = true;
    bool sends_ = false, asked_ = false;    ///< each turn; the next one
    bool intensity_ = false, wide_ = false; ///< of 16 bits
    std::uint64_t every_ = 1;               ///< turns
    std::uint32_t telegrams_ = 0;
};

void SickEmulator::hear(std::uint8_t byte) {
    if (byte == textBegin) { // CoLa B begins with it too, but no text follows: it gets no answer
        request_.clear();
    } else if (byte == textEnd) {
        std::istringstream text(std::exchange(request_, {}));
        if (text.peek() != 's')
            return;
        if (const std::string said = answer({std::istream_iterator<std::string>(text), {}}); !said.empty())
            tell(said);
    } else if (request_.size() < longestText) {
        request_.push_back(char(byte));
    }
}

std::string SickEmulator::answer(const Words &words) {
    const std::string &command = words[0], name = words.size() > 1 ? words[1] : "";
    if (command == "sRN")
        return read(name);
    if (command == "sWN")
        return write(name, words);
    if (command == "sMN")
        return call(name, words);
    if (command != "sEN" || name != "LMDscandata" || words.size() < 3)
        return command == "sEN" ? unknownEvent : unknownCommand;
    sends_ = numberOf(words[2]) != 0;
    return "sEA LMDscandata " + std::to_string(sends_);
}

std::string SickEmulator::read(const std::string &variable) {
    if (variable == "SCdevicestate")
        return isBroken() ? "sRA SCdevicestate 2" : "sRA SCdevicestate 1";
    if (variable == "LMPoutputRange")
        return "sRA LMPoutputRange 1 " + hex(type_.angleStep) + ' ' + hex(firstAngle) + ' ' + hex(lastAngle);
    if (variable != "LMDscandata")
        return unknownVariable;
    asked_ = true; // the next turn answers
    return {};
}

std::string SickEmulator::write(const std::string &variable, const Words &words) {
    if (variable != "EIHstCola" && variable != "LMDscandatacfg")
        return unknownVariable;
    if (!loggedIn_)
        return writeDenied;
    if (variable == "EIHstCola")
        return words.back() == "0" ? "sWA EIHstCola" : invalidData; // no CoLa B
    if (words.size() < 14 || numberOf(words.back()) < 1)
        return invalidData;
    intensity_ = numberOf(words[4]) != 0;
    wide_ = numberOf(words[5]) != 0;
    every_ = std::uint64_t(numberOf(words.back()));
    return "sWA LMDscandatacfg";
}

std::string SickEmulator::call(const std::string &method, const Words &words) {
    if (method == "SetAccessMode") {
        loggedIn_ = words.size() == 4 && numberOf(words[2]) == 3 && words[3] == "F4724744";
        return "sAN SetAccessMode " + std::to_string(loggedIn_);
    }
    if (method == "Run") {
        loggedIn_ = false;
        return "sAN Run 1";
    }
    const bool starts = method == "LMCstartmeas", reboots = method == "mSCreboot";
    if (!starts && !reboots && method != "LMCstopmeas")
        return unknownMethod;
    if (!loggedIn_)
        return accessDenied;
    if (!reboots) {
        measures_ = starts;
        return "sAN " + method + " 0";
    }
    mend();
    hangUp();
    return "sAN mSCreboot";
}

void SickEmulator::pass(int step) {
    if (step != last_)
        return;
    if (std::exchange(asked_, false))
        tell("sRA" + telegram());
    if (sends_ && revolutions() % every_ == 0)
        tell("sSN" + telegram());
}

/// A range or an intensity for each direction.
std::string SickEmulator::channel(const char *name, bool intensity) const {
    std::string text = std::string(" ") + name + " 3F800000 00000000 " + hex(firstAngle) + ' ' +
                       hex(type_.angleStep) + ' ' + hex(type_.values);
    for (int i = first_; i <= last_; ++i) {
        const int mm = ranges()[std::size_t(i)];
        const int value = intensity ? valueIntensity : mm, none = intensity ? 0 : nothing;
        text += ' ' + hex(mm >= leastRange_mm ? value : none);
    }
    return text;
}

std::string SickEmulator::telegram() {
    const std::string intensities = intensity_ ? channel("RSSI1", true) : "";
    return " LMDscandata 1 1 F510AB 0 " + hex(isBroken()) + ' ' + hex(telegrams_++) + ' ' +
           hex(std::int64_t(revolutions())) + ' ' + hex(begin_us()) + ' ' + hex(clock_us()) + " 0 0 1 0 0 " +
           hex(std::lround(model().turns_hz * 100)) + ' ' + hex(model().points_hz / 100) +
           (intensity_ && wide_ ? " 0 2" : " 0 1") + channel("DIST1", false) + (wide_ ? intensities : "") +
           (intensity_ && !wide_ ? " 1" + intensities : " 0") +
           " 0 1 B not defined 0 0 0"; // place, name, comment, time, event
}

} // namespace

const ScannerModel::Make makeSick = makeOf<SickEmulator>;

} // namespace hermes::simulator
