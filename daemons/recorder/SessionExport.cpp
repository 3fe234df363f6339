#include "daemons/recorder/SessionExport.h"

#include "common/Project.h"
#include "common/capture/PcapWriter.h"
#include "common/recording/DiskError.h"
#include "daemons/recorder/CarmenText.h"
#include "daemons/recorder/ExportFiles.h"
#include "daemons/recorder/RosBag.h"
#include "protocol/mcap/Writer.h"
#include "protocol/wire/JsonText.h"

#include <QDir>
#include <QJsonObject>
#include <QRegularExpression>
#include <algorithm>
#include <cmath>
#include <filesystem>

namespace hermes::recorder {
namespace {

/// Files by topic and schema: one that changed in a restart is told from the one before.
template <typename File>
using BySchema = std::map<std::pair<QString, std::string>, File>;

std::pair<QString, std::string> keyOf(const SessionMessage &message) {
    return {message.topic, message.schema ? message.schema->data : std::string()};
}

/// A table of one topic.
class Sheet {
public:
    Sheet(ExportFile &file, const mcap::Schema *schema)
        : file_(file) {
        if (schema)
            addColumns(
                {},
                parseJson(QByteArray::fromStdString(schema->data), nullptr).value_or(QJsonValue()).toObject(),
                0);
        if (columns_.empty())
            columns_.emplace_back();
        QStringList titles{"stamp", "t_s", "seq"};
        for (const QStringList &column : columns_)
            titles.append(column.isEmpty()                    ? QString("data")
                          : titles.contains(column.join('.')) ? quoted("data." + column.join('.'))
                                                              : textCell(column.join('.')));
        write(titles);
    }

    void take(const SessionMessage &message) {
        const WireValue data = message.data();
        QStringList cells{QString::number(message.stamp, 'f', 6), QString::number(message.t_s, 'f', 6),
                          QString::number(message.raw.sequence)};
        for (const QStringList &column : columns_) {
            WireView value = data;
            for (const QString &member : column)
                value = value[member.toUtf8().constData()];
            cells.append(cell(value));
        }
        write(cells);
    }

private:
    static constexpr int deepest = 10;
    static constexpr std::size_t mostColumns = 1000;

    void addColumns(const QStringList &path, const QJsonObject &schema, int depth) {
        const QJsonObject members = schema["properties"].toObject();
        if ((members.isEmpty() || depth == deepest) && !path.isEmpty() && columns_.size() < mostColumns)
            columns_.push_back(path);
        if (depth < deepest)
            for (auto member = members.begin(); member != members.end(); ++member)
                addColumns(path + QStringList(member.key()), member->toObject(), depth + 1);
    }
    static QString quoted(QString text) {
        if (!text.contains(QRegularExpression("[\",\r\n]")))
            return text;
        return '"' + text.replace('"', "\"\"") + '"';
    }
    /// A spreadsheet would take some texts for formulas: an apostrophe tells it that they are none.
    static QString textCell(const QString &text) {
        static const QString begins("=+-@\t\r");
        return quoted(!text.isEmpty() && begins.contains(text[0]) ? '\'' + text : text);
    }
    static QString cell(WireView value) {
        switch (value.kind()) {
        case WireView::Kind::Undefined:
        case WireView::Kind::Null:
            return {};
        case WireView::Kind::Text:
            return textCell(value.text());
        default: // numbers as they came
            return quoted(QString::fromUtf8(compactJson(value.toJson())));
        }
    }
    void write(const QStringList &cells) { file_.write(cells.join(',').toUtf8() + '\n'); }

    ExportFile &file_;
    std::vector<QStringList> columns_; ///< each the members that lead to it; none: all of the data
};

/// Poses of one topic.
struct Trajectory {
    ExportFile *file = nullptr;
    double last = 0; ///< stamp

    void take(const SessionMessage &message) {
        const WireValue data = message.data();
        const WireView inner = data["pose"], pose = inner.kind() == WireView::Kind::Object ? inner : data;
        const double x = pose["x"].number(), y = pose["y"].number(), half = pose["theta"].number() / 2;
        if (!std::isfinite(x + y + half) || message.stamp <= last)
            return;
        last = message.stamp;
        file->write(QString("%1 %2 %3 0 0 0 %4 %5\n")
                        .arg(last, 0, 'f', 6)
                        .arg(x, 0, 'f', 6)
                        .arg(y, 0, 'f', 6)
                        .arg(std::sin(half), 0, 'f', 9)
                        .arg(std::cos(half), 0, 'f', 9)
                        .toUtf8());
    }
};

mcap::Writer::Sink sinkOf(ExportFile &file) {
    return [&file](std::string_view bytes) {
        file.write(QByteArray::fromRawData(bytes.data(), int(bytes.size())));
        return true;
    };
}

std::string library() {
    return "hermes " + projectVersion().toStdString();
}

/// One MCAP file of all.
class McapCopy {
public:
    explicit McapCopy(ExportFile &file)
        : writer_(sinkOf(file), library()) {}

    void take(const SessionMessage &message) {
        const auto key = std::pair(keyOf(message), message.channel.metadata);
        auto known = channels_.find(key);
        if (known == channels_.end()) {
            const mcap::Schema *schema = message.schema;
            const auto id =
                schema ? writer_.addSchema(schema->name, schema->encoding, schema->data) : std::uint16_t(0);
            const auto channel = schema && id == 0
                                     ? id
                                     : writer_.addChannel(id, message.channel.topic, message.channel.encoding,
                                                          message.channel.metadata);
            hasRoom_ = hasRoom_ && channel != 0;
            known = channels_.emplace(key, channel).first;
        }
        mcap::Message copy = message.raw;
        copy.channel = known->second;
        writer_.write(copy);
    }
    /// false: one file cannot hold all that was taken.
    bool finish() {
        writer_.finish();
        return hasRoom_;
    }

private:
    mcap::Writer writer_;
    bool hasRoom_ = true; ///< for schemas and channels
    std::map<std::pair<std::pair<QString, std::string>, std::map<std::string, std::string>>, std::uint16_t>
        channels_;
};

/// The capture files in a folder, LOGGER-0001.pcap and on: of each logger, in order. A name may have any
/// bytes.
std::map<QString, std::vector<std::string>> capturesIn(const QString &folder) {
    static const QRegularExpression numbered("^(.+)-[0-9]{4,}\\.pcap$");
    const std::string place = QFile::encodeName(folder).toStdString();
    std::vector<std::string> names;
    std::error_code error;
    for (std::filesystem::directory_iterator file(place, error), end; file != end; file.increment(error))
        names.push_back(file->path().filename().string());
    std::sort(names.begin(), names.end(), [](const std::string &a, const std::string &b) {
        return std::pair(a.size(), a) < std::pair(b.size(), b); // 9999 comes before 10000
    });
    std::map<QString, std::vector<std::string>> captures;
    for (const std::string &name : names)
        if (const auto match = numbered.match(QString::fromLatin1(name.c_str())); match.hasMatch())
            captures[match.captured(1)].push_back(place + '/' + name);
    return captures;
}

/// Files as one, and how many packets they have. What is not whole in one ends it, which is noted.
quint64 join(SessionReader &session, const std::vector<std::string> &captures, ExportFile &file) {
    PcapWriter writer;
    Outcome<void> done = writer.open(file.draft());
    for (auto path = captures.begin(); done && path != captures.end(); ++path) {
        const auto read = readPcapTail(*path, 0, [&](const Datagram &datagram) {
            done = writer.write(datagram);
            return done && !session.isStopped();
        });
        if (!read) {
            session.note(QString::fromStdString(read.error()));
            continue;
        }
        if (done && (read->wholeBytes < read->fileBytes || read->wholeBytes == 0))
            session.note(QString("%1: only %2 of its %3 bytes could be read, %4 packets%5")
                             .arg(QString::fromStdString(*path))
                             .arg(read->wholeBytes)
                             .arg(read->fileBytes)
                             .arg(read->packets)
                             .arg(read->packets == 0
                                      ? QString()
                                      : QString(", the last at %1 s of the session")
                                            .arg(1e-9 * double(read->last_ns) - session.start(), 0, 'f', 2)));
    }
    const quint64 packets = writer.packets();
    if (done)
        done = writer.close();
    if (!done)
        file.fail(done.error());
    return packets;
}

SessionReader::Wanted wantedOf(const QStringList &topics) {
    if (topics.isEmpty())
        return {};
    QStringList patterns;
    for (const QString &topic : topics)
        patterns.append(topicPattern(topic));
    const QRegularExpression any(patterns.join('|'));
    return [any](const QString &topic) { return any.match(topic).hasMatch(); };
}

} // namespace

double captureBytes(const QString &folder) {
    double sum = 0;
    for (const auto &[logger, names] : capturesIn(folder))
        for (const std::string &name : names) {
            std::error_code error;
            const auto bytes = std::filesystem::file_size(name, error);
            sum += error ? 0 : double(bytes);
        }
    return sum;
}

Result<SessionFiles> exportSession(SessionReader &session, const QString &format, const QStringList &topics,
                                   const QString &into, const QString &profile) {
    if (!profile.isEmpty() && (profile != "ros2" || format != "mcap"))
        return Error(ErrorCode::InvalidParams,
                     "profile: found " + profile + " with " + format + ", expected ros2 with mcap");
    ExportFiles files(into);
    if (const auto begun = files.begin(); !begun)
        return begun.error();
    quint64 messages = 0; ///< or packets
    const auto readAll = [&](const QStringList &usual, const auto &take) {
        session.read(wantedOf(topics.isEmpty() ? usual : topics), [&](const SessionMessage &message) {
            ++messages;
            take(message);
        });
    };
    const QString name = session.recorded().name;
    if (format == "csv") {
        BySchema<Sheet> sheets;
        readAll({}, [&](const SessionMessage &message) {
            auto known = sheets.find(keyOf(message));
            if (known == sheets.end())
                known =
                    sheets.emplace(keyOf(message), Sheet(files.open(message.topic, ".csv"), message.schema))
                        .first;
            known->second.take(message);
        });
    } else if (format == "tum") {
        std::map<QString, Trajectory> trajectories;
        readAll({"scanmatcher/pose"}, [&](const SessionMessage &message) {
            Trajectory &trajectory = trajectories[message.topic];
            if (!trajectory.file)
                trajectory.file = &files.open(message.topic, ".tum");
            trajectory.take(message);
        });
    } else if (format == "carmen") {
        CarmenText text;
        ExportFile &file = files.open(name, ".log");
        readAll(CarmenText::topics(), [&](const SessionMessage &message) {
            file.write(text.take(message)); // of one that gives no line nothing
        });
        if (text.scans() == 0)
            return Error(ErrorCode::NotReady, session.folder() + ": found no scan with odometry, expected " +
                                                  CarmenText::topics().join(" and "));
    } else if (profile == "ros2") {
        mcap::Writer writer(sinkOf(files.open(name, ".ros2.mcap")), library(), 1 << 20, "ros2");
        RosBag bag(writer);
        readAll({}, [&](const SessionMessage &message) { bag.take(message); });
        writer.finish();
        messages = bag.messages();
        if (bag.unreadable() != 0)
            session.note(QString("%1 messages could not be read").arg(bag.unreadable()));
    } else if (format == "mcap") {
        McapCopy copy(files.open(name, ".mcap"));
        readAll({}, [&](const SessionMessage &message) { copy.take(message); });
        if (!copy.finish())
            return Error(ErrorCode::OverLimit, session.folder() +
                                                   ": found topics with schemas of more than " +
                                                   QString::number(mcap::mostDefinitions) +
                                                   " bytes, expected fewer in one file: export fewer topics");
    } else if (format == "pcap") {
        const auto captures = capturesIn(session.folder());
        if (captures.empty() || !topics.isEmpty())
            return captures.empty()
                       ? Error(ErrorCode::NotReady,
                               session.folder() + ": found no capture of a lidar, expected LOGGER-0001.pcap")
                       : Error(ErrorCode::InvalidParams,
                               "topics: found " + topics.join(", ") + ", expected none with pcap");
        for (const auto &[logger, names] : captures)
            messages += join(session, names, files.open(logger, ".pcap"));
    } else {
        return Error(ErrorCode::InvalidParams,
                     "format: found " + format + ", expected csv, tum, carmen, mcap or pcap");
    }
    if (session.isStopped())
        return Error(ErrorCode::NotReady, session.folder() + ": the program ends; nothing was exported");
    if (const Result<void> written = files.finish(); !written)
        return written.error();
    const QStringList problems = session.recorded().problems() + session.problems();
    if (messages == 0)
        return Error(ErrorCode::NotReady, session.folder() + ": found no " +
                                              (format == "pcap" ? "packets" : "messages of these topics") +
                                              ", expected some" +
                                              (problems.isEmpty() ? QString() : ": " + problems.join("; ")));
    const Result<QStringList> paths = files.commit();
    return paths ? Result<SessionFiles>(SessionFiles{*paths, problems}) : paths.error();
}

} // namespace hermes::recorder
