#include "daemons/seriallogger/LoggedPort.h"

#include "common/Time.h"

#include <QDateTime>

namespace hermes::seriallogger {

namespace {

// What is so long without an NMEA sentence, of 82 bytes at most, is something else.
constexpr quint64 foreignBytes = 1000;
constexpr double foreign_s = 3;

QString dateText(double stamp) {
    return QDateTime::fromSecsSinceEpoch(qint64(stamp), Qt::UTC).date().toString(Qt::ISODate);
}

QString toText(Interface::State state) {
    return state == Interface::State::Open      ? "open"
           : state == Interface::State::Opening ? "opening"
                                                : "closed";
}

} // namespace

LoggedPort::LoggedPort(const PortSettings &settings, std::size_t queueBytes, std::function<void()> viewFilled,
                       PortThread::Note note)
    : settings_(settings)
    , recording_(queueBytes)
    , view_(settings)
    , thread_(settings.name, settings.url, recording_, view_.queue(), std::move(viewFilled),
              std::move(note)) {}

void LoggedPort::start() {
    startedMono_ = monotonicNow();
    view_.open();
    thread_.start();
}

void LoggedPort::tick(double elapsed_s) {
    const quint64 bytes = thread_.state().counters.bytesIn;
    rate_ = elapsed_s > 0 ? double(bytes - bytesAtTick_) / elapsed_s : 0;
    bytesAtTick_ = bytes;
    if (const quint64 sentences = view_.fixes().sentences().sentences;
        sentences != sentences_ || bytes == 0 || !view_.isOpen()) { // in a replay nobody looks for any
        sentences_ = sentences;
        bytesAtSentence_ = bytes;
        sentenceMono_ = monotonicNow();
    }
}

bool LoggedPort::isForeign() const {
    return settings_.view == PortSettings::View::Nmea && bytesAtTick_ - bytesAtSentence_ > foreignBytes &&
           monotonicNow() - sentenceMono_ > foreign_s;
}

PortStatus LoggedPort::status() const {
    const PortThread::State state = thread_.state();
    PortStatus port;
    port.name = settings_.name;
    port.url = settings_.url;
    port.state = toText(state.carrier);
    port.reason = state.reason;
    port.device = state.device;
    port.opened = state.counters.opened;
    port.failures = state.counters.errors;
    port.bytes = state.counters.bytesIn;
    port.bytesPerSecond = rate_;
    port.sent = state.counters.bytesOut;
    port.lost = recording_.lost();
    port.viewLost = view_.queue().lost();
    port.systemErrors = state.systemErrors;
    if (state.last)
        port.lastStamp = state.last->stamp();
    if (settings_.view == PortSettings::View::Nmea) {
        port.nmea = nmeaCounts();
        port.fix.emplace();
        if (view_.lastFix())
            *port.fix = valuesOf(*view_.lastFix());
    }
    return port;
}

NmeaCounts LoggedPort::nmeaCounts() const {
    const nmea::SentenceParser::Counts &counts = view_.fixes().sentences();
    const FixTracker::Counts &fixes = view_.fixes().counts();
    NmeaCounts nmea{counts.sentences,
                    counts.badChecksum,
                    counts.noChecksum,
                    counts.tooLong,
                    counts.badByte,
                    counts.cutShort,
                    counts.skippedBytes,
                    fixes.badFields,
                    fixes.repeated,
                    fixes.late,
                    {}};
    if (const nmea::FieldFault &fault = view_.fixes().lastFault())
        nmea.lastFault = QString("field %1: expected %2").arg(fault.field).arg(fault.expected);
    return nmea;
}

std::pair<HealthLevel, QString> LoggedPort::health() {
    const PortThread::State state = thread_.state();
    if (state.carrier != Interface::State::Open)
        return {HealthLevel::Failed,
                state.reason.isEmpty() ? settings_.url + ": not open yet" : state.reason};
    const double since = state.last ? state.last->mono() : startedMono_;
    const double silent = monotonicNow() - since;
    if (settings_.silence_s > 0 && silent > settings_.silence_s)
        return {HealthLevel::Stale,
                QString("no byte on %1 for %2 s").arg(settings_.url).arg(silent, 0, 'f', 1)};
    if (isForeign())
        return {HealthLevel::Failed, QString("%1 bytes came on %2 and no NMEA sentence in them; expected a "
                                             "GPS receiver that talks at this baud rate")
                                         .arg(bytesAtTick_ - bytesAtSentence_)
                                         .arg(settings_.url)};
    quint64 errors = 0;
    for (const quint64 count : state.systemErrors)
        errors += count;
    // The first may have been begun before; what the checksum says is right may say what it likes.
    const nmea::SentenceParser::Counts &counts = view_.fixes().sentences();
    const auto butOne = [](quint64 wrong) { return wrong > 1 ? wrong : 0; };
    const quint64 damaged = butOne(counts.badChecksum + counts.tooLong + counts.badByte + counts.cutShort);
    const quint64 noChecksum = butOne(counts.noChecksum), unread = butOne(view_.fixes().counts().badFields);
    QString message = "receiving from " + (state.device.isEmpty() ? settings_.url : state.device);
    if (recording_.lost() > 0)
        message += QString("; %1 bytes were lost: the disk was too slow").arg(recording_.lost());
    if (errors > 0)
        message += QString("; the system tells of %1 errors on the line").arg(errors);
    if (damaged > 0)
        message += QString("; %1 NMEA sentences were damaged").arg(damaged);
    if (state.strangers.datagrams > 0)
        message += QString("; %1 datagrams of %2 are not read, from=ADDRESS in the url chooses")
                       .arg(state.strangers.datagrams)
                       .arg(state.strangers.names.join(", "));
    if (noChecksum > 0)
        message += QString("; %1 had no checksum: checksum=lenient accepts them").arg(noChecksum);
    if (unread > 0)
        message += QString("; %1 positions could not be read: %2")
                       .arg(unread)
                       .arg(nmeaCounts().lastFault.value_or(QString()));
    const std::optional<Fix> &fix = view_.lastFix();
    const bool isRolledOver = fix && fix->time && nmea::isRolledOver(*fix->time, fix->arrival.stamp());
    if (isRolledOver)
        message += "; the receiver tells " + dateText(*fix->time) +
                   ", 1024 weeks off the clock: its count of weeks began anew (GPS week roll-over)";
    const quint64 wrong =
        recording_.lost() + errors + damaged + noChecksum + unread + state.strangers.datagrams;
    const HealthLevel level = faults_.level(double(wrong));
    return {isRolledOver && level == HealthLevel::Ok ? HealthLevel::Warn : level, message};
}

} // namespace hermes::seriallogger
