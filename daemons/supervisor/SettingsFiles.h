#pragma once

#include "common/Result.h"

#include <QJsonObject>
#include <QStringList>

namespace hermes::supervisor {

class Replacement;

/// The settings files of the daemons of this computer, one a daemon, and samples of those of whole robots.
class SettingsFiles {
public:
    /// folder: of the files, NAME.json; samples: of folders of such files.
    SettingsFiles(QString folder, QString samples)
        : folder_(std::move(folder))
        , samples_(std::move(samples)) {}

    QString path(const QString &daemon) const { return folder_ + '/' + daemon + ".json"; }
    /// The settings of each daemon that has a file. Error: one cannot be read.
    Result<QJsonObject> current() const;
    /// The same without those that cannot be read.
    QJsonObject readable() const;
    /// Of these daemons, what is wrong with each file that cannot be read.
    QStringList unreadable(const QStringList &daemons) const;
    QStringList sampleNames() const;
    /// The same of a sample, with this folder where it names the usual one. Error: there is none of that
    /// name.
    Result<QJsonObject> sample(const QString &name) const;

    /// Replaces the files of these daemons when there is room for all of them, else nothing; those that were
    /// there stay beside, as NAME.json.previous. Gives the files. Error: what could not be written, or
    /// problem().
    Result<QStringList> write(const QJsonObject &settings) const;
    /// Puts those back that the last write() has replaced, all or none; where there was none, one without
    /// settings. What was there stays beside, as NAME.json.undone. Error: nothing was replaced, or cannot be.
    Result<QStringList> undo() const;
    /// The daemons whose files undo() would put back.
    QStringList undoable() const;
    /// What is wrong with the files as a whole: that write() or undo() was cut off, as by a kill, when some
    /// of them were replaced and others not. undo() puts back all of them. Nothing is wrong: empty.
    QString problem() const;

private:
    /// Replaces files while a mark says that they are not whole.
    Result<void> commit(Replacement &files) const;
    /// The file that is there meanwhile.
    QString mark() const { return folder_ + "/setup.unfinished"; }

    QString folder_, samples_;
};

} // namespace hermes::supervisor
