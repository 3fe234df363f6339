#pragma once

#include "common/Result.h"
#include "common/schema/Field.h"
#include "common/schema/SchemaValidator.h"

#include <QJsonObject>
#include <QObject>
#include <QStringList>
#include <functional>
#include <optional>

namespace hermes {

/// The largest settings file that is read, and written.
constexpr qint64 maxSettingsBytes = 1 << 20;

/// The text of a settings file, without waiting for anybody: devices and pipes are refused.
Result<QByteArray> readSettingsFile(const QString &name);

/// Whether a settings file of this text may be put there: it can be read again, and replaces no device or
/// pipe.
Result<void> checkSettingsFile(const QString &name, const QByteArray &text);

/// The settings of a program: declared once with schema and default, always valid, changed all or nothing,
/// kept in a JSON file. A dot in a name makes a group: "motor.radius_m" is {"motor": {"radius_m": ...}}.
class Settings : public QObject {
    Q_OBJECT
public:
    /// Checks what a schema cannot say (one value against another); gives what is wrong.
    using Rule = std::function<std::vector<SchemaViolation>(const QJsonObject &settings)>;

    explicit Settings(QObject *parent = nullptr);

    /// Declares a setting. It must have a default.
    void declare(const Field &field);
    void addRule(Rule rule) { rules_.push_back(std::move(rule)); }

    /// The JSON Schema of all settings, with `x-applies` ("now" or "restart") on each.
    QJsonObject schema() const { return fullSchema_; }
    const QJsonObject &values() const { return current_; }
    /// The same, but for changes that wait for a restart.
    const QJsonObject &inForce() const { return inForce_; }
    const QJsonObject &defaults() const { return initial_; }
    /// Only what differs from the defaults.
    QJsonObject changes() const;

    /// A value in force, by its dotted path; a path that was not declared gives undefined.
    QJsonValue value(const QString &path) const;
    double number(const QString &path) const { return value(path).toDouble(); }
    int integer(const QString &path) const { return int(value(path).toDouble()); }
    bool flag(const QString &path) const { return value(path).toBool(); }
    QString text(const QString &path) const { return value(path).toString(); }

    /// Applies all of a partial object or nothing. InvalidSetting: data.errors has path, value, expected.
    /// Gives the dotted paths whose value changed.
    Result<QStringList> set(const QJsonObject &partial);
    /// The same, as told on the command line: a file that is read later changes nothing of it.
    Result<QStringList> insist(const QJsonObject &partial);
    /// Whether each of these values, with the others as they are, suits the schema, whatever rules say of
    /// them.
    bool suitsSchema(const QJsonObject &partial) const;
    /// Puts the values at or below these paths back to their defaults; without paths, all of them.
    Result<QStringList> reset(const QStringList &paths = {});

    /// The defaults with what a file of settings changes, and over that what was insisted on. Errors name the
    /// file, the line or path, what was found and what was expected.
    Result<QJsonObject> read(const QString &file) const;
    /// Takes what read() gives, and remembers the file for save().
    Result<void> load(const QString &file);
    /// The file that was loaded; empty: none.
    const QString &file() const { return fileName_; }
    /// Writes what differs from the defaults, atomically, to the file given or loaded; gives its name. What
    /// is no regular file is not replaced, and what load() would not read is not written.
    Result<QString> save(const QString &file = QString()) const;

    /// The program starts its work: from now on those that apply on restart keep in force the value they
    /// have.
    void begin();
    /// Part of the program begins anew: what waits for a restart is in force, but for these paths.
    void takeWaiting(const QStringList &butFor);
    /// Those of the paths that apply on restart.
    QStringList needRestart(const QStringList &paths) const;
    /// The paths whose change waits for a restart.
    QStringList waiting() const;

Q_SIGNALS:
    /// After a change that was applied, with the dotted paths of the values that differ.
    void changed(const QStringList &paths);

private:
    Result<QStringList> apply(const QJsonObject &proposed);
    QStringList take(const QJsonObject &values);
    void put(const QJsonObject &values);
    std::vector<SchemaViolation> checkSchema(const QJsonObject &proposed) const;
    std::vector<SchemaViolation> check(const QJsonObject &proposed) const;

    QJsonObject fullSchema_;
    QJsonObject initial_;
    QJsonObject current_;
    QJsonObject inForce_;
    QJsonObject insisted_;
    bool begun_ = false;
    QString fileName_;
    std::vector<Rule> rules_;
    mutable std::optional<SchemaValidator> validator_; // made anew after declare()
};

} // namespace hermes
