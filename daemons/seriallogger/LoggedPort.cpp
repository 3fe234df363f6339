#include "daemons/seriallogger/LoggedPort.h"

#include "common/Time.h"
#include "daemons/seriallogger/FixJson.h"

namespace hermes {

namespace {

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
    , thread_(settings, recording_, view_.queue(), std::move(viewFilled), std::move(note)) {}

void LoggedPort::start() {
    startedMono_ = monotonicNow();
    view_.open();
    thread_.start();
}

void LoggedPort::tick(double elapsed_s) {
    const quint64 bytes = thread_.state().counters.bytesIn;
    rate_ = elapsed_s > 0 ? double(bytes - bytesAtTick_) / elapsed_s : 0;
    bytesAtTick_ = bytes;
}

QJsonObject LoggedPort::toJson() const {
    const PortThread::State state = thread_.state();
    QJsonObject errors;
    for (auto error = state.systemErrors.begin(); error != state.systemErrors.end(); ++error)
        errors.insert(error.key(), double(*error));
    QJsonObject port{{"name", settings_.name},
                     {"url", settings_.url},
                     {"state", toText(state.carrier)},
                     {"reason", state.reason},
                     {"device", state.device},
                     {"opened", double(state.counters.opened)},
                     {"failures", double(state.counters.errors)},
                     {"bytes", double(state.counters.bytesIn)},
                     {"bytes_per_s", rate_},
                     {"sent", double(state.counters.bytesOut)},
                     {"lost", double(recording_.lost())},
                     {"view_lost", double(view_.queue().lost())},
                     {"system_errors", errors}};
    port.insert("last_stamp", state.last ? QJsonValue(state.last->stamp()) : QJsonValue());
    if (settings_.view == PortSettings::View::Nmea) {
        port.insert("nmea", nmeaJson());
        port.insert("fix", view_.lastFix() ? QJsonValue(hermes::toJson(*view_.lastFix())) : QJsonValue());
    }
    return port;
}

QJsonObject LoggedPort::nmeaJson() const {
    const nmea::SentenceParser::Counts &counts = view_.fixes().sentences();
    const FixTracker::Counts &fixes = view_.fixes().counts();
    QJsonObject nmea{
        {"sentences", double(counts.sentences)},        {"bad_checksum", double(counts.badChecksum)},
        {"no_checksum", double(counts.noChecksum)},     {"too_long", double(counts.tooLong)},
        {"bad_byte", double(counts.badByte)},           {"cut_short", double(counts.cutShort)},
        {"skipped_bytes", double(counts.skippedBytes)}, {"bad_fields", double(fixes.badFields)},
        {"repeated", double(fixes.repeated)},           {"late", double(fixes.late)}};
    if (view_.fixes().lastFault())
        nmea.insert("last_fault", QString("field %1: expected %2")
                                      .arg(view_.fixes().lastFault().field)
                                      .arg(view_.fixes().lastFault().expected));
    return nmea;
}

std::pair<HealthLevel, QString> LoggedPort::health() const {
    const PortThread::State state = thread_.state();
    if (state.carrier != Interface::State::Open)
        return {HealthLevel::Failed,
                state.reason.isEmpty() ? settings_.url + ": not open yet" : state.reason};
    const double since = state.last ? state.last->mono() : startedMono_;
    const double silent = monotonicNow() - since;
    if (settings_.silence_s > 0 && silent > settings_.silence_s)
        return {HealthLevel::Stale,
                QString("no byte on %1 for %2 s").arg(settings_.url).arg(silent, 0, 'f', 1)};
    if (recording_.lost() > 0)
        return {HealthLevel::Warn,
                QString("%1 bytes were lost: the disk was too slow").arg(recording_.lost())};
    quint64 errors = 0;
    for (const quint64 count : state.systemErrors)
        errors += count;
    if (errors > 0)
        return {HealthLevel::Warn, QString("the system tells of %1 errors on the line").arg(errors)};
    const nmea::SentenceParser::Counts &counts = view_.fixes().sentences();
    const quint64 wrong = counts.badChecksum + counts.noChecksum + counts.tooLong + counts.badByte +
                          counts.cutShort + view_.fixes().counts().badFields;
    if (wrong > 1) // the first may have been begun before
        return {HealthLevel::Warn, QString("%1 NMEA sentences were damaged").arg(wrong)};
    return {HealthLevel::Ok, "receiving from " + (state.device.isEmpty() ? settings_.url : state.device)};
}

} // namespace hermes
