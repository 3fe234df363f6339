#include "daemons/recorder/SessionExport.h"

#include "common/Project.h"
#include "common/files/SavedFile.h"
#include "common/recording/DiskError.h"
#include "daemons/recorder/CarmenText.h"
#include "protocol/mcap/Writer.h"
#include "protocol/wire/JsonText.h"

#include <QDir>
#include <QJsonObject>
#include <QRegularExpression>
#include <QSet>
#include <cmath>
#include <memory>

namespace hermes::recorder {
namespace {

/// The files of one export.
class ExportFiles {
public:
    explicit ExportFiles(const QString &folder)
        : folder_(folder) {}

    Result<void> begin() const {
        return QFileInfo(folder_).isSymLink() || !QDir().mkpath(folder_)
                   ? Result<void>(diskError(folder_ + ": is no folder, and cannot be made one", folder_))
                   : Result<void>();
    }
    /// name: of a topic, or a session. Null: it cannot be written, which commit() tells.
    SavedFile *open(QString name, const QString &extension) {
        name.replace(QRegularExpression("[^A-Za-z0-9._-]|^\\."), "-");
        QString unique = name.left(longestName) + extension;
        for (int number = 2; names_.contains(unique.toLower()); ++number)
            unique = QString("%1-%2%3").arg(name.left(longestName)).arg(number).arg(extension);
        names_.insert(unique.toLower());
        const QString path = QDir(folder_).filePath(unique);
        if (QFileInfo(path).isSymLink())
            QFile::remove(path); // else what it leads to is written
        auto file = std::make_unique<SavedFile>(path);
        if (const auto begun = file->begin(); !begun) {
            fault_ = begun.error();
            return nullptr;
        }
        files_.push_back(std::move(file));
        return files_.back().get();
    }
    Result<QStringList> commit() {
        QStringList paths;
        if (fault_)
            return *fault_;
        for (const auto &file : files_) {
            if (const auto done = file->commit(); !done)
                return done.error();
            paths.append(file->fileName());
        }
        return paths;
    }

private:
    static constexpr int longestName = 150;

    QString folder_;
    QSet<QString> names_; ///< in small letters: some disks know no others
    std::vector<std::unique_ptr<SavedFile>> files_;
    std::optional<Error> fault_;
};

/// Files by topic and schema: one that changed in a restart is told from the one before.
template <typename File>
using BySchema = std::map<std::pair<QString, std::string>, File>;

std::pair<QString, std::string> keyOf(const SessionMessage &message) {
    return {message.topic, message.schema ? message.schema->data : std::string()};
}

/// A table of one topic.
class Sheet {
public:
    Sheet(SavedFile *file, const mcap::Schema *schema)
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
                                                              : quoted(column.join('.')));
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
    static QString cell(WireView value) {
        switch (value.kind()) {
        case WireView::Kind::Undefined:
        case WireView::Kind::Null:
            return {};
        case WireView::Kind::Text:
            return quoted(value.text());
        default: // numbers as they came
            return quoted(QString::fromUtf8(compactJson(value.toJson())));
        }
    }
    void write(const QStringList &cells) {
        if (file_)
            file_->write(cells.join(',').toUtf8() + '\n');
    }

    SavedFile *file_;
    std::vector<QStringList> columns_; ///< each the members that lead to it; none: all of the data
};

/// Poses of one topic.
struct Trajectory {
    SavedFile *file = nullptr;
    double last = 0; ///< stamp

    void take(const SessionMessage &message) {
        const WireValue data = message.data();
        const WireView inner = data["pose"], pose = inner.kind() == WireView::Kind::Object ? inner : data;
        const double x = pose["x"].number(), y = pose["y"].number(), half = pose["theta"].number() / 2;
        if (!file || !std::isfinite(x + y + half) || message.stamp <= last)
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

/// One MCAP file of all.
class McapCopy {
public:
    explicit McapCopy(SavedFile *file)
        : writer_(
              [file](std::string_view bytes) {
                  return file && file->write(bytes.data(), qint64(bytes.size())) == qint64(bytes.size());
              },
              "hermes " + projectVersion().toStdString()) {}

    void take(const SessionMessage &message) {
        const auto key = std::pair(keyOf(message), message.channel.metadata);
        auto known = channels_.find(key);
        if (known == channels_.end()) {
            const mcap::Schema *schema = message.schema;
            const auto id =
                schema ? writer_.addSchema(schema->name, schema->encoding, schema->data) : std::uint16_t(0);
            known = channels_
                        .emplace(key, writer_.addChannel(id, message.channel.topic, message.channel.encoding,
                                                         message.channel.metadata))
                        .first;
        }
        mcap::Message copy = message.raw;
        copy.channel = known->second;
        writer_.write(copy);
    }
    void finish() { writer_.finish(); }

private:
    mcap::Writer writer_;
    std::map<std::pair<std::pair<QString, std::string>, std::map<std::string, std::string>>, std::uint16_t>
        channels_;
};

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

Result<QStringList> exportSession(SessionReader &session, const QString &format, const QStringList &topics,
                                  const QString &into) {
    ExportFiles files(into);
    if (const auto begun = files.begin(); !begun)
        return begun.error();
    quint64 messages = 0;
    const auto readAll = [&](const QStringList &usual, const auto &take) {
        session.read(wantedOf(topics.isEmpty() ? usual : topics), [&](const SessionMessage &message) {
            ++messages;
            take(message);
        });
    };
    const QString name = session.summary().name;
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
                trajectory.file = files.open(message.topic, ".tum");
            trajectory.take(message);
        });
    } else if (format == "carmen") {
        CarmenText text;
        SavedFile *file = files.open(name, ".log");
        readAll(CarmenText::topics(), [&](const SessionMessage &message) {
            if (const QByteArray line = text.take(message); file && !line.isEmpty())
                file->write(line);
        });
        if (text.scans() == 0)
            return Error(ErrorCode::NotReady, session.folder() + ": found no scan with odometry, expected " +
                                                  CarmenText::topics().join(" and "));
    } else if (format == "mcap") {
        McapCopy copy(files.open(name, ".mcap"));
        readAll({}, [&](const SessionMessage &message) { copy.take(message); });
        copy.finish();
    } else {
        return Error(ErrorCode::InvalidParams,
                     "format: found " + format + ", expected csv, tum, carmen or mcap");
    }
    if (messages == 0)
        return Error(ErrorCode::NotReady,
                     session.folder() + ": found no messages of these topics, expected some");
    return files.commit();
}

} // namespace hermes::recorder
