#include "daemons/supervisor/SerialProbe.h"

#include "common/Time.h"
#include "common/interface/AnySpeed.h"
#include "daemons/supervisor/PortUsers.h"
#include "protocol/drive/ArduinoDevice.h"
#include "protocol/drive/OpenCrDevice.h"
#include "protocol/drive/RoboteqDevice.h"
#include "protocol/drive/VescDevice.h"
#include "protocol/nmea/SentenceParser.h"
#include "protocol/roboclaw/Packet.h"
#include "protocol/scan/ScannerModel.h"

#include <QElapsedTimer>
#include <QFile>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace hermes::supervisor {
namespace {

constexpr int talkerBauds[] = {9600, 4800, 38400, 115200}; // the usual one first
constexpr int controllerBauds[] = {115200, 38400, 460800}; // the same
constexpr int listen_ms = 1200;                            // a receiver says something each second
constexpr int answer_ms = 60, patientAnswer_ms = 200; // 50 bytes, and an adapter that holds them for 16 ms
constexpr int longest_ms = 14000, longestScanner_ms = 4000, scannerStep_ms = 10; // until its motor turns
constexpr int slice_ms = 50; // between two looks whether to give up
constexpr int allAddresses = roboclaw::lastAddress - roboclaw::firstAddress + 1;

/// The first whole sentence; empty: none.
QString sentenceIn(const QByteArray &bytes) {
    nmea::SentenceParser parser;
    int begin = 0;
    for (int i = 0; i < bytes.size(); ++i) {
        if (bytes[i] == '$' || bytes[i] == '!')
            begin = i;
        if (parser.feed(bytes[i]) == nmea::SentenceParser::Result::Done)
            return QString::fromLatin1(bytes.mid(begin, i - begin).trimmed());
    }
    return {};
}

/// The version in an answer; empty: it is none.
QString versionIn(const roboclaw::Request &request, const QByteArray &bytes) {
    roboclaw::ReplyParser parser;
    parser.begin(request);
    for (const char byte : bytes) {
        const auto result = parser.feed(std::uint8_t(byte));
        if (result == roboclaw::ReplyParser::Result::Done)
            return QString::fromLatin1(parser.reply().text.data());
        if (result != roboclaw::ReplyParser::Result::Incomplete)
            return {};
    }
    return {};
}

} // namespace

FoundSerial SerialProbe::run() {
    begun_.start();
    found_.path = candidate_.path;
    found_.device = candidate_.device;
    found_.about = candidate_.about;
    found_.kind = "failed";
    found_.text = open();
    if (port_ >= 0 && found_.text.isEmpty() && !listen()) {
        found_.kind = mayAsk_.controller ? "silent" : "not_asked";
        if (mayAsk_.controller)
            ask();
        if (mayAsk_.others && found_.kind != "roboclaw" && !askOthers())
            findScanner(false);
    }
    if (found_.kind == "talker")
        findScanner(true);
    if (isGone_ && found_.kind != "nmea" && found_.kind != "roboclaw" && found_.kind != "scanner") {
        found_.kind = "failed";
        found_.text = "went away during the search";
    }
    close();
    return found_;
}

QString SerialProbe::open() {
    const QString user = PortUsers::ofDevice(candidate_.device);
    if (!user.isEmpty()) {
        found_.kind = "in_use";
        return user;
    }
    port_ =
        ::open(QFile::encodeName(candidate_.device).constData(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (port_ < 0 && errno == EBUSY)
        found_.kind = "in_use";
    if (port_ < 0)
        return QString("cannot be opened: ") + std::strerror(errno) +
               (errno == EACCES ? "; who uses serial lines is in the group dialout" : "");
    int isClaimed = 0;
    if (::ioctl(port_, TIOCGEXCL, &isClaimed) == 0 && isClaimed != 0) {
        found_.kind = "in_use";
        return "a program that has claimed it for itself";
    }
    if (::isatty(port_) == 0 || ::ioctl(port_, TIOCEXCL) != 0)
        return "is no serial line";
    before_.emplace();
    ::tcgetattr(port_, &*before_);
    return {};
}

void SerialProbe::close() {
    if (port_ < 0)
        return;
    if (before_) {
        ::tcsetattr(port_, TCSANOW, &*before_);
        ::ioctl(port_, TIOCNXCL);
    }
    ::close(port_);
    port_ = -1;
}

void SerialProbe::setBaud(int baud) {
    termios settings{};
    ::tcgetattr(port_, &settings);
    ::cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cflag &= ~tcflag_t(CRTSCTS | CSTOPB);
    ::tcsetattr(port_, TCSANOW, &settings);
    setSpeed(port_, baud);
    ::tcflush(port_, TCIOFLUSH);
}

void SerialProbe::send(std::string_view bytes) {
    if (!bytes.empty() && ::write(port_, bytes.data(), bytes.size()) != ssize_t(bytes.size()))
        isGone_ = errno != EAGAIN;
}

/// Some lines have none.
void SerialProbe::setDtr(bool on) {
    const int signal = TIOCM_DTR;
    (void)::ioctl(port_, on ? TIOCMBIS : TIOCMBIC, &signal);
}

template <typename Enough>
QByteArray SerialProbe::receive(int most_ms, const Enough &enough) {
    QByteArray bytes;
    QElapsedTimer waiting;
    waiting.start();
    for (qint64 left = most_ms; left > 0 && !isCancelled_; left = most_ms - waiting.elapsed()) {
        pollfd ready{port_, POLLIN, 0};
        if (::poll(&ready, 1, int(std::min<qint64>(left, slice_ms))) <= 0)
            continue;
        std::array<char, 512> some{};
        const auto count = ::read(port_, some.data(), some.size());
        if (count <= 0) {
            isGone_ = true;
            break;
        }
        bytes.append(some.data(), int(count));
        if (enough(bytes))
            break;
    }
    return bytes;
}

bool SerialProbe::listen() {
    for (const int baud : talkerBauds) {
        setBaud(baud);
        QString sentence;
        const QByteArray bytes = receive(listen_ms, [&sentence](const QByteArray &all) {
            sentence = sentenceIn(all);
            return !sentence.isEmpty();
        });
        if (!sentence.isEmpty()) {
            found_.kind = "nmea";
            found_.text = sentence;
            found_.baud = baud;
            return true;
        }
        if (bytes.isEmpty() && found_.kind != "talker")
            return false; // at a wrong baud rate something would have come, too
        found_.kind = "talker";
        found_.text = "talks by itself, but not in NMEA sentences; it was asked nothing";
    }
    return true;
}

/// True: it is a motor controller of another kind. What an Arduino is asked, its encoders, comes first:
/// opening its line may have restarted it, which takes about as long as the questions before. What was asked
/// at other baud rates may lie in a Roboteq, where the first question ends it, and in a VESC as the beginning
/// of a packet, which has to be filled.
bool SerialProbe::askOthers() {
    using namespace drive;
    using Kind = drive::Command::Kind;
    ArduinoDevice arduino;
    RoboteqDevice roboteq;
    OpenCrDevice opencr;
    VescDevice vesc(VescDevice::alone);
    return askAs("arduino", ArduinoDevice::usualBaud, arduino, {Kind::ReadEncoders}) ||
           askAs("roboteq", RoboteqDevice::usualBaud, roboteq, {Kind::SetUp}) ||
           askAs("roboteq", RoboteqDevice::usualBaud, roboteq, {Kind::SetUp}) ||
           askAs("opencr", OpenCrDevice::usualBaud, opencr, {Kind::ReadEncoders}) ||
           askAs("vesc", VescDevice::usualBaud, vesc, {Kind::SetUp}, VescDevice::longestPacket);
}

/// The question moves nothing, and only that kind answers so. It comes behind so many zeros.
bool SerialProbe::askAs(const char *kind, int baud, drive::MotorDevice &device,
                        const drive::Command &question, std::size_t zeros) {
    setBaud(baud);
    const drive::Bytes request = device.bytes(question);
    device.reader().begin(request);
    send(std::string(zeros, 0).append(reinterpret_cast<const char *>(request.data()), request.size()));
    auto result = drive::ReplyReader::Result::Incomplete;
    int taken = 0;
    receive(patientAnswer_ms, [&](const QByteArray &all) {
        while (taken < all.size() && result == drive::ReplyReader::Result::Incomplete)
            result = device.reader().feed(std::uint8_t(all[taken++]));
        return result != drive::ReplyReader::Result::Incomplete;
    });
    if (result == drive::ReplyReader::Result::Incomplete)
        result = device.reader().silence();
    if (result != drive::ReplyReader::Result::Done)
        return false;
    drive::Readings readings;
    device.take(question, readings);
    found_.kind = kind;
    found_.text = QString::fromStdString(device.version());
    found_.baud = baud;
    return true;
}

/// Of the scanners that send by themselves, or of those that are asked, which never are where somebody talks.
void SerialProbe::findScanner(bool isOneWay) {
    for (const scan::ScannerModel *const model : scan::scannerSearch(true)) {
        if (model->isOneWay != isOneWay || isGone_ || isCancelled_)
            continue;
        setBaud(model->baud);
        scan::RevolutionAssembler revolutions([](const scan::Revolution &) {});
        const auto scanner = model->make(*model, revolutions);
        scanner->opened(Moment::now().mono_ns);
        QElapsedTimer waiting;
        for (waiting.start(); waiting.elapsed() < longestScanner_ms && begun_.elapsed() < longest_ms &&
                              !isGone_ && !isCancelled_;) {
            const scan::HostAction asked =
                isOneWay ? scan::HostAction() : scanner->next(Moment::now().mono_ns);
            if (asked.dtr)
                setDtr(*asked.dtr);
            send(asked.send);
            const QByteArray bytes = receive(scannerStep_ms, [](const QByteArray &) { return true; });
            const Moment now = Moment::now();
            if (!bytes.isEmpty())
                scanner->feed({bytes.constData(), std::size_t(bytes.size())}, {now.stamp_ns, now.mono_ns});
            const scan::Search verdict = scan::verdictOf(*model, *scanner, double(waiting.elapsed()) * 1e-3);
            if (verdict == scan::Search::GoesOn)
                continue;
            if (!isOneWay && scanner->counts().packets > 0) { // the next search hears it else
                send(scanner->farewell());
                receive(slice_ms,
                        [](const QByteArray &) { return false; }); // before the line has another speed
            }
            if (verdict == scan::Search::Other)
                break;
            const std::string &device = scanner->identity().model;
            const scan::ScannerModel *const named = scan::namedModel(*model, device);
            found_.kind = "scanner";
            found_.model = (named ? named : model)->name;
            found_.baud = model->baud;
            found_.text = device.empty() ? model->title : QString::fromStdString(device);
            return;
        }
    }
}

void SerialProbe::ask() {
    for (const int baud : controllerBauds)
        if (askAt(baud, answer_ms))
            return;
}

/// True: there are controllers. One that answers late spoils the answer of the next: then all are asked
/// again, more patiently.
bool SerialProbe::askAt(int baud, int timeout_ms) {
    setBaud(baud);
    bool isSpoilt = false;
    for (int address = roboclaw::firstAddress; address <= roboclaw::lastAddress && !isCancelled_; ++address) {
        const auto request = roboclaw::Request::make(std::uint8_t(address), roboclaw::Command::ReadVersion);
        if (::write(port_, request->bytes.data(), request->bytes.size()) != ssize_t(request->bytes.size()))
            isGone_ = errno != EAGAIN;
        if (isGone_)
            return false;
        QString version;
        const QByteArray answer = receive(timeout_ms, [&](const QByteArray &bytes) {
            version = versionIn(*request, bytes);
            return !version.isEmpty();
        });
        if (!version.isEmpty()) {
            found_.text = version;
            found_.addresses.push_back(address);
        }
        isSpoilt = isSpoilt || (version.isEmpty() && !answer.isEmpty());
    }
    if (isSpoilt && timeout_ms < patientAnswer_ms) {
        found_.addresses.clear();
        found_.text.clear();
        return askAt(baud, patientAnswer_ms);
    }
    if (found_.addresses.empty()) {
        if (isSpoilt) {
            found_.kind = "other";
            found_.text = "answers, but not as a RoboClaw does; so it looks, too, where two have one address";
        }
        return false;
    }
    found_.kind = "roboclaw";
    found_.baud = baud;
    found_.anyAddress = int(found_.addresses.size()) == allAddresses;
    return true;
}

} // namespace hermes::supervisor
