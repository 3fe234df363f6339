#include "daemons/supervisor/SettingsFiles.h"

#include "common/Project.h"
#include "common/files/SavedFile.h"
#include "common/recording/FileSync.h"
#include "common/settings/Settings.h"
#include "protocol/wire/JsonText.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonDocument>
#include <memory>
#include <unistd.h>
#include <vector>

namespace hermes::supervisor {
namespace {

constexpr const char *usualFolder = "/etc/hermes/"; // as samples name it
constexpr const char *previous = ".previous", *undone = ".undone";

Error fileError(const QString &path, const QString &reason) {
    return Error(ErrorCode::InputOutput, QString("%1: %2").arg(path, reason), QJsonObject{{"path", path}});
}

Result<QJsonObject> parsed(const QString &path, const QByteArray &text) {
    WireError error;
    const auto value = parseJson(text, &error);
    if (!value)
        return fileError(path, QString("line %1: %2").arg(error.line).arg(error.message));
    if (!value->isObject())
        return fileError(path, "line 1: expected a JSON object");
    return value->toObject();
}

} // namespace

/// Files that are replaced together: their texts lie on the disk before the first one is.
class Replacement {
public:
    Result<void> add(const QString &path, const QByteArray &text) {
        if (const auto fine = checkSettingsFile(path, text); !fine)
            return fine.error();
        files_.push_back(std::make_unique<SavedFile>(path));
        SavedFile &file = *files_.back();
        if (const auto begun = file.begin(); !begun)
            return begun;
        file.write(text);
        return file.sync();
    }

    /// In the order in which they were added.
    Result<void> commit() {
        for (const auto &file : files_)
            if (const auto done = file->commit(); !done)
                return done;
        return {};
    }

private:
    std::vector<std::unique_ptr<SavedFile>> files_;
};

namespace {

/// A file of settings; from stands for to in it.
Result<QJsonObject> settingsIn(const QString &path, const QByteArray &from = {}, const QByteArray &to = {}) {
    auto text = readSettingsFile(path);
    if (!text)
        return text.error();
    return parsed(path, from.isEmpty() ? *text : text->replace(from, to));
}

/// The file of each daemon that has one in a folder.
Result<QJsonObject> readAll(const QString &folder, const QByteArray &from = {}, const QByteArray &to = {}) {
    QJsonObject all;
    for (const QString &daemon : daemonNames()) {
        const QString path = folder + '/' + daemon + ".json";
        if (!QFile::exists(path))
            continue;
        const auto settings = settingsIn(path, from, to);
        if (!settings)
            return settings.error();
        all.insert(daemon, *settings);
    }
    return all;
}

} // namespace

Result<QJsonObject> SettingsFiles::current() const {
    return readAll(folder_);
}

QJsonObject SettingsFiles::readable() const {
    QJsonObject all;
    for (const QString &daemon : daemonNames())
        if (const auto settings = settingsIn(path(daemon)))
            all.insert(daemon, *settings);
    return all;
}

QStringList SettingsFiles::unreadable(const QStringList &daemons) const {
    QStringList wrong;
    for (const QString &daemon : daemons)
        if (QFile::exists(path(daemon)))
            if (const auto settings = settingsIn(path(daemon)); !settings)
                wrong.append(settings.error().message +
                             "; what it said of access, listening and limits is not taken over");
    return wrong;
}

QStringList SettingsFiles::sampleNames() const {
    return QDir(samples_).entryList(QDir::Dirs | QDir::NoDotAndDotDot, QDir::Name);
}

Result<QJsonObject> SettingsFiles::sample(const QString &name) const {
    if (!sampleNames().contains(name))
        return Error(ErrorCode::InvalidParams,
                     QString("there is no sample \"%1\" in %2, %3")
                         .arg(name, samples_,
                              sampleNames().isEmpty()
                                  ? "nor any other; the setting setup.samples names their folder"
                                  : "expected one of: " + sampleNames().join(", ")));
    return readAll(samples_ + '/' + name, usualFolder, QFile::encodeName(folder_) + '/');
}

Result<QStringList> SettingsFiles::write(const QJsonObject &settings) const {
    if (const QString cutOff = problem(); !cutOff.isEmpty())
        return Error(ErrorCode::NotReady, cutOff + "; nothing was changed");
    Replacement old, now;
    QStringList files;
    for (const QString &daemon : settings.keys()) {
        const QFileInfo there(path(daemon));
        const bool isEmpty = !there.exists() || (there.isFile() && there.size() == 0);
        const auto before = isEmpty ? Result<QByteArray>(QByteArray("{}\n")) : readSettingsFile(path(daemon));
        if (!before)
            return before.error();
        auto added = old.add(path(daemon) + previous, *before);
        if (added)
            added = now.add(path(daemon), QJsonDocument(settings[daemon].toObject()).toJson());
        if (!added)
            return Error(ErrorCode::InputOutput, added.error().message + "; nothing was changed",
                         added.error().data);
        files.append(path(daemon));
    }
    for (const QString &daemon : undoable()) // what setup.undo finds is always of one time
        QFile::remove(path(daemon) + previous);
    // On the disk before the mark is: commit() begins with that.
    if (const auto kept = old.commit(); !kept)
        return Error(ErrorCode::InputOutput, kept.error().message + "; nothing was changed",
                     kept.error().data);
    if (const auto done = commit(now); !done)
        return Error(ErrorCode::InputOutput, done.error().message + "; setup.undo puts back what was there",
                     done.error().data);
    return files;
}

Result<void> SettingsFiles::commit(Replacement &files) const {
    if (const auto fine = checkSettingsFile(mark(), {}); !fine) // to open a pipe would wait
        return fine;
    // In this order on the disk, too: the power may fail.
    syncFolder(folder_);
    if (QFile file(mark()); !file.open(QIODevice::WriteOnly))
        return fileError(mark(), file.errorString());
    syncFolder(folder_);
    const auto done = files.commit();
    syncFolder(folder_);
    if (done) {
        QFile::remove(mark());
        syncFolder(folder_);
    }
    return done;
}

QString SettingsFiles::problem() const {
    if (!QFile::exists(mark()))
        return {};
    return QString("%1: setup.apply or setup.undo was cut off, and some settings files are replaced, others "
                   "not; setup.undo puts back what was there")
        .arg(folder_);
}

QStringList SettingsFiles::undoable() const {
    QStringList daemons;
    for (const QString &daemon : daemonNames())
        if (QFile::exists(path(daemon) + previous))
            daemons.append(daemon);
    return daemons;
}

Result<QStringList> SettingsFiles::undo() const {
    Replacement kept, replacement;
    QStringList files;
    for (const QString &daemon : undoable()) {
        const auto before = readSettingsFile(path(daemon) + previous);
        if (!before)
            return before.error();
        const auto now = readSettingsFile(path(daemon));
        auto added = now ? kept.add(path(daemon) + undone, *now) : Result<void>();
        if (added)
            added = replacement.add(path(daemon), *before);
        if (!added)
            return Error(ErrorCode::InputOutput, added.error().message + "; nothing was changed",
                         added.error().data);
        files.append(path(daemon));
    }
    if (files.isEmpty()) {
        QFile::remove(mark()); // no undo makes the files whole
        return Error(
            ErrorCode::NotReady,
            QString("there is nothing to undo: no file in %1 ends in .json%2").arg(folder_, previous));
    }
    auto done = kept.commit();
    if (done)
        done = commit(replacement);
    if (!done)
        return done.error();
    for (const QString &file : files)
        QFile::remove(file + previous);
    return files;
}

} // namespace hermes::supervisor
