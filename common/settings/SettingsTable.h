#pragma once

#include "common/settings/Settings.h"
#include "protocol/wire/Fields.h"

#include <functional>
#include <type_traits>
#include <vector>

namespace hermes {

/// The settings that fill a struct: each is told once, with the member that takes its value; what the member
/// holds is the default. A table is made with the struct, most often by deriving a struct of members from it,
/// and the members must stay where they are. Settings that a program reads by their names need no member:
///
///     group("Wheels");
///     add("frame.wheel_radius_m", wheelRadius, "Radius of a wheel", "m", 0.01, 1);
///     define("frame.colour", "red", "Of the wheels");
class SettingsTable {
public:
    enum class Applies { Now, OnRestart };

    SettingsTable() = default;
    SettingsTable(const SettingsTable &) = delete;
    SettingsTable &operator=(const SettingsTable &) = delete;

    /// Those that follow stand under this heading.
    void group(const char *heading, Applies applies = Applies::Now) {
        heading_ = heading;
        applies_ = applies;
    }
    /// The kind of the setting is that of the member: number, integer, boolean or text.
    template <typename T>
    Field &add(const char *name, T &member, const char *description) {
        const auto take = [&member](const QJsonValue &value) {
            if constexpr (std::is_same_v<T, bool>)
                member = value.toBool();
            else if constexpr (std::is_same_v<T, QString>)
                member = value.toString();
            else
                member = T(value.toDouble());
        };
        return append(name, &member, description, schemaOf<T>(), asJson(member), take);
    }
    template <typename T>
    Field &add(const char *name, T &member, const char *description, const char *unit, double least,
               double most) {
        return add(name, member, description).unit(QLatin1String(unit)).range(least, most);
    }
    /// One without a member. usual: its default, whose kind is that of the setting.
    template <typename T>
    Field &define(const QString &name, const T &usual, const QString &description) {
        using Value = std::conditional_t<std::is_convertible_v<T, QString>, QString, T>;
        return append(name, nullptr, description, schemaOf<Value>(), asJson(Value(usual)),
                      [](const QJsonValue &) {});
    }
    template <typename T>
    Field &define(const QString &name, const T &usual, const QString &description, const char *unit,
                  double least, double most) {
        return define(name, usual, description).unit(QLatin1String(unit)).range(least, most);
    }
    /// A list of such elements, empty by default.
    Field &defineList(const QString &name, const QString &description, const QJsonObject &elementSchema);

    void declareIn(Settings &settings) const;
    /// Fills the members from settings that suit the schema.
    void read(const QJsonObject &settings);

    // Settings that were read may demand something of one another: a member stands for its setting.
    template <typename T>
    void require(bool isFine, const T &member, const QString &expected) {
        if (!isFine)
            refuse(&member, expected);
    }
    void notAbove(const double &member, const double &limit) {
        require(member <= limit, member, QStringLiteral("at most ") + nameOf(&limit));
    }
    void notBelow(const double &member, const double &limit) {
        require(member >= limit, member, QStringLiteral("at least ") + nameOf(&limit));
    }
    const std::vector<SchemaViolation> &violations() const { return violations_; }

private:
    struct Entry {
        Field field;
        const void *member;
        std::function<void(const QJsonValue &value)> take;
    };

    Field &append(const QString &name, const void *member, const QString &description,
                  const QJsonObject &schema, const QJsonValue &initial,
                  const std::function<void(const QJsonValue &value)> &take);
    void refuse(const void *member, const QString &expected);
    QString nameOf(const void *member) const;

    QString heading_;
    Applies applies_ = Applies::Now;
    std::vector<Entry> entries_;
    QJsonObject read_;
    std::vector<SchemaViolation> violations_;
};

} // namespace hermes
