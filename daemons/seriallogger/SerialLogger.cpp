#include "daemons/seriallogger/SerialLogger.h"

#include "common/Log.h"
#include "common/recording/DiskError.h"
#include "common/recording/SessionFolder.h"
#include "daemons/seriallogger/SerialExport.h"
#include "protocol/wire/Fields.h"

#include <QDir>
#include <QFile>
#include <QJsonDocument>

#include <algorithm>

namespace hermes::seriallogger {

namespace {

constexpr int viewPeriod_ms = 20; // rather than to wake up for each byte

Error wrongParameter(const QString &name, const QString &found, const QString &expected) {
    return invalidParams({{name, found, expected}},
                         QString("%1: found \"%2\", expected %3").arg(name, found, expected));
}

/// The marks among the events of a recording that has ended, in the order of the file. Lines that are no
/// marks, or make no sense, are passed over. InputOutput: the events cannot be read. Blocks.
Result<std::vector<RecordedMark>> readMarks(const StoredRecording &recording) {
    constexpr std::size_t maxMarks = 1000;
    constexpr qint64 longestLine = 1 << 14; // bytes; a text has at most 1000 characters
    QFile file(QDir(recording.folder).filePath("seriallogger-events.jsonl"));
    std::vector<RecordedMark> marks;
    if (!file.exists()) // cut off as it was made
        return marks;
    if (!file.open(QIODevice::ReadOnly))
        return diskError(file.fileName() + ": cannot be read: " + file.errorString(), file.fileName());
    const double startMono_s = recording.sidecar.value("start_mono").toDouble();
    while (!file.atEnd() && marks.size() < maxMarks) {
        const QJsonObject event = QJsonDocument::fromJson(file.readLine(longestLine)).object();
        if (event["event"] != QJsonValue("mark") || !event["text"].isString())
            continue;
        const double stamp = event["stamp"].toDouble();
        const double t_s =
            event["mono"].isDouble() ? event["mono"].toDouble() - startMono_s : stamp - recording.start_s;
        marks.push_back({t_s, stamp, event["text"].toString()});
    }
    return marks;
}

} // namespace

SerialLogger::SerialLogger()
    : Daemon({"seriallogger", "Serial logger",
              "Records the bytes of serial lines, UDP and TCP sources as they come, with the time of each; "
              "shows lines and GPS fixes"})
    , recording_("seriallogger", settings(), health(), recorder_) {
    declareSettings();
    declareTopics();
    declareCommands();
    exports_.setMaxThreadCount(1);
    reads_.setMaxThreadCount(1);
    connect(&second_, &QTimer::timeout, this, &SerialLogger::tick);
    connect(this, &Daemon::clientGone, this, [this](quint64 client) { source_.clientGone(client); });
    viewTimer_.setSingleShot(true);
    connect(&viewTimer_, &QTimer::timeout, this, &SerialLogger::processViews);
    settleTimer_.setSingleShot(true);
    connect(&settleTimer_, &QTimer::timeout, this, &SerialLogger::processViews);
}

Result<void> SerialLogger::start() {
    std::vector<SerialRecorder::Port> recorded;
    for (const PortSettings &port : PortSettings::read(settings().values())) {
        addPort(port);
        recorded.push_back({port.name, port.url, &ports_.back()->recordingQueue()});
    }
    recorder_.setPorts(std::move(recorded));
    recording_.open();
    for (const auto &port : ports_)
        port->start();
    source_.opened(ReplaySource::State::Live, "the ports");
    sinceTick_.start();
    second_.start(1000);
    setState(ports_.empty() ? DaemonState::Ready : DaemonState::Running);
    updateHealth();
    return {};
}

void SerialLogger::addPort(const PortSettings &settings) {
    const auto note = [this, name = settings.name](const QString &event, QJsonObject details) {
        if (event == "opened")
            logInfo(name, "open");
        else if (event == "closed")
            logWarning(name, details.value("reason").toString());
        details.insert("port", name);
        recorder_.note(event, details);
    };
    const auto queueBytes = std::size_t(this->settings().integer("record.queue_bytes"));
    ports_.push_back(std::make_unique<LoggedPort>(settings, queueBytes, viewFilled(), note));
    health().provide("port " + settings.name, [this, port = ports_.back().get()] { updateHealth(*port); });
}

void SerialLogger::stop() {
    second_.stop();
    viewTimer_.stop();
    settleTimer_.stop();
    cancelExports_ = true;
    source_.close();
    player_.stop();
    for (const auto &port : ports_)
        port->thread().end();
    recording_.close();
    exports_.waitForDone();
    reads_.waitForDone();
}

LoggedPort *SerialLogger::findPort(const QString &name) const {
    for (const auto &port : ports_)
        if (port->settings().name == name)
            return port.get();
    return nullptr;
}

Error SerialLogger::noSuchPort(const QString &name) const {
    QStringList names;
    for (const auto &port : ports_)
        names << port->settings().name;
    return wrongParameter("port", name, "one of: " + names.join(", "));
}

Result<MarkAnswer> SerialLogger::mark(const Call &call) {
    const Moment now = Moment::now();
    if (!recorder_.note("mark", {{"text", call.text("text")}}, now))
        return Error(ErrorCode::NotReady, "nothing is being recorded, or the disk does not keep up; "
                                          "record.start begins");
    return MarkAnswer{now.stamp(), now.mono()};
}

void SerialLogger::send(const Call &call, const Reply &reply) {
    LoggedPort *port = findPort(call.text("port"));
    if (!port)
        return reply.error(noSuchPort(call.text("port")));
    const QString expected = "either bytes, as pairs of hexadecimal digits, or text, and not nothing";
    QByteArray bytes = call.text("text").toUtf8();
    if (call.has("bytes")) {
        const QString digits = call.text("bytes").remove(' ');
        bytes = QByteArray::fromHex(digits.toLatin1());
        if (call.has("text") || bytes.toHex() != digits.toLower().toUtf8())
            bytes.clear();
    }
    if (bytes.isEmpty())
        return reply.error(wrongParameter("bytes", call.text("bytes"), expected));
    const auto write = [this, port, bytes, reply](Interface &carrier) {
        const QString name = port->settings().name;
        if (!carrier.write(bytes))
            return reply.error(
                Error(ErrorCode::NotReady,
                      carrier.isOpen()
                          ? QString("%1: %2 does not take more bytes now").arg(name, port->settings().url)
                          : QString("%1 is closed: %2").arg(name, port->thread().state().reason)));
        carrier.flush();
        recorder_.note("sent", {{"port", name}, {"bytes", QString::fromLatin1(bytes.toHex())}});
        const auto answer = [bytes, reply](Interface &) { reply.result(asJson(SendAnswer{bytes.size()})); };
        port->thread().with(answer); // the port's state counts them by then
    };
    port->thread().with(write);
}

void SerialLogger::exportRecording(const Call &call, const Reply &reply) {
    const QString name = call.text("name"), port = call.text("port"), rows = call.text("rows");
    Result<void> fine = checkName("name", name);
    if (fine)
        fine = checkName("port", port);
    if (!fine)
        return reply.error(fine.error());
    const QString base =
        QDir(QDir(settings().text("record.folder")).absoluteFilePath(name)).filePath("seriallogger-" + port);
    SerialExport job;
    job.base = base;
    job.target = base + '-' + rows + ".csv";
    job.rows = rows == "lines" ? ExportRows::Lines : rows == "bytes" ? ExportRows::Bytes : ExportRows::Fixes;
    const LoggedPort *known = findPort(port);
    job.checksum = known ? known->settings().checksum : nmea::ChecksumRule::Strict;
    if (QFile::exists(job.target) && !call.flag("force"))
        return reply.error(diskError(job.target + ": it exists already; force=true replaces it", job.target));
    exports_.start(QRunnable::create([this, job, reply] {
        const Result<quint64> count = job.run(cancelExports_);
        reply.give(count ? Result<ExportAnswer>({job.target, *count}) : Result<ExportAnswer>(count.error()));
    }));
}

void SerialLogger::listMarks(const Call &call, const Reply &reply) {
    const Result<StoredRecording> stored =
        StoredRecording::find(settings().text("record.folder"), call.text("name"), identity().name);
    if (!stored)
        return reply.error(stored.error());
    reads_.start(QRunnable::create([recording = *stored, reply] { reply.give(readMarks(recording)); }));
}

std::function<void()> SerialLogger::viewFilled() {
    return [this] {
        const auto later = [this] {
            if (!viewTimer_.isActive())
                viewTimer_.start(viewPeriod_ms);
        };
        QMetaObject::invokeMethod(this, later, Qt::QueuedConnection);
    };
}

PortView::Sinks SerialLogger::sinks(const QString &port, bool isReplayed) {
    const auto line = [this, port](const LineSplitter::Line &found) {
        const auto message = [&] {
            return LineMessage{port, found.arrival.stamp(), found.arrival.mono(),
                               QString::fromStdString(escaped(found.bytes)), found.cut};
        };
        publish("lines", message, found.arrival.stamp());
    };
    const auto fix = [this, port, isReplayed](const Fix &found) {
        publish("fix", FixMessage{port, valuesOf(found), isReplayed}, found.arrival.stamp());
    };
    return {line, fix};
}

void SerialLogger::processViews() {
    std::optional<int> next_ms;
    for (const auto &port : ports_) {
        const PortView::Sinks shown = sinks(port->settings().name, false);
        port->view().process(shown);
        if (const auto wait_ms = port->view().settle(shown))
            next_ms = std::min(*wait_ms, next_ms.value_or(*wait_ms));
    }
    for (auto &[port, view] : replayed_)
        view.process(sinks(port, true));
    if (next_ms)
        settleTimer_.start(*next_ms);
    else
        settleTimer_.stop();
}

void SerialLogger::tick() {
    const double elapsed_s = double(sinceTick_.restart()) * 1e-3;
    for (const auto &port : ports_)
        port->tick(elapsed_s);
    updateHealth();
    publish("serial", [this] { return state(); });
}

SerialMessage SerialLogger::state() const {
    return {portList(), recording_.isActive(), source_.status()};
}

void SerialLogger::updateHealth() {
    updateSourceHealth();
    for (const auto &port : ports_)
        updateHealth(*port);
    if (ports_.empty())
        health().set("ports", HealthLevel::Warn, "no port is set; the setting ports lists them");
}

void SerialLogger::updateHealth(LoggedPort &port) {
    const auto [level, message] = port.health();
    health().set("port " + port.settings().name, level, message, asJson(port.status()).toObject());
}

std::vector<PortStatus> SerialLogger::portList() const {
    std::vector<PortStatus> list;
    for (const auto &port : ports_)
        list.push_back(port->status());
    return list;
}

} // namespace hermes::seriallogger
