#pragma once

#include "common/Result.h"
#include "common/Role.h"
#include "common/daemon/Reply.h"
#include "common/schema/Field.h"
#include "common/schema/SchemaValidator.h"
#include "protocol/wire/FieldsOf.h"

#include <QJsonObject>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

namespace hermes {

/// One call of a command, its parameters already checked against the declaration and completed with defaults.
struct Call {
    QJsonObject params;
    quint64 client = 0;         ///< who calls; the same for one connection as long as it lasts
    QString clientName;         ///< for messages
    Role role = Role::Engineer; ///< of who calls
    QString moreRights;         ///< how that client could get more of them
    double time = 0;            ///< when it came, before all that came later; of the clock of bootNow()
    double earliest = 0;        ///< of the same: since then the client has always had something unread

    bool has(const char *name) const { return params.contains(QLatin1String(name)); }
    QJsonValue value(const char *name) const { return params.value(QLatin1String(name)); }
    double number(const char *name) const { return value(name).toDouble(); }
    int integer(const char *name) const { return int(value(name).toDouble()); }
    bool flag(const char *name) const { return value(name).toBool(); }
    QString text(const char *name) const { return value(name).toString(); }
    /// NotAuthorised: `what` is for this role.
    Error notFor(const QString &what, Role needed) const;
};

/// What a handler gives when nothing goes wrong.
template <typename T>
struct Given {
    using Type = T;
};
template <typename T>
struct Given<Result<T>> {
    using Type = T;
};

/// A command, declared once: description, validation, help and dispatch follow from it.
/// `Command("motor.drive", "Drives with this twist").param(...).returns(...).handler(...)`.
class Command {
public:
    using Handler = std::function<Result<QJsonValue>(const Call &)>;
    using AsyncHandler = std::function<void(const Call &, const Reply &)>;

    Command(const QString &name, const QString &summary);

    /// One with `x-role`: only who has that role may give it another value than the default.
    Command &param(const Field &field);
    /// The JSON Schema of the result, e.g. {{"type", "number"}}.
    Command &returns(const QJsonObject &schema);
    /// The struct, with fields, that the result is.
    template <typename T>
    Command &gives() {
        return returns(schemaOf<T>());
    }
    Command &returnsNull();
    Command &example(const QJsonObject &params, const QJsonValue &result);
    /// Any further keyword of the description, e.g. "x-needs-lease".
    Command &with(const QString &keyword, const QJsonValue &value);
    /// `x-role`: who may call it; without a word, operators.
    Command &needs(Role role);
    /// `x-urgent`: a stop. Goes before all other work, a place is kept for clients that call it, and it is
    /// never refused for its form: a parameter that does not fit counts as not given.
    Command &urgent();
    /// `x-fresh`: not carried out when it was received before the program had stood still.
    Command &fresh();
    /// How many values its parameters may hold: the time to check them is the daemon's, and everybody's.
    Command &takes(int values);
    /// Not in the description: it is of the connection, not of the daemon.
    Command &unlisted();
    /// Sent again and again, so that the audit sums it up.
    Command &stream();
    /// Answers at once with what the function gives, or with its error: a struct with fields, a list, a text,
    /// or null where it gives nothing. What the result is follows from that.
    template <typename Function>
    Command &answers(const Function &function) {
        using Value = typename Given<std::invoke_result_t<Function, const Call &>>::Type;
        if constexpr (std::is_void_v<Value>)
            returnsNull();
        else
            gives<Value>();
        return handler([function](const Call &call) -> Result<QJsonValue> {
            if constexpr (std::is_void_v<std::invoke_result_t<Function, const Call &>>) {
                function(call);
                return QJsonValue();
            } else {
                const Result<Value> given = function(call);
                if (!given)
                    return given.error();
                if constexpr (std::is_void_v<Value>)
                    return QJsonValue();
                else if constexpr (std::is_constructible_v<QJsonValue, const Value &>)
                    return QJsonValue(*given); // a description of 32 kB is not copied
                else
                    return asJson(*given);
            }
        });
    }
    /// Answers at once with JSON of its own.
    Command &handler(const Handler &function);
    /// Answers at once or later, through the Reply.
    Command &asyncHandler(const AsyncHandler &function);

    const QString &name() const { return commandName_; }
    Role role() const { return role_; }
    bool isUrgent() const { return extra_.contains(urgentKey()); }
    bool needsFresh() const { return extra_.contains(freshKey()); }
    /// It changes something, or stops: who calls it is written down.
    bool isAudited() const { return role_ > Role::Observer || isUrgent(); }
    /// Sent again and again: who drives, or replays topics.
    bool isSetPoint() const { return isStream_ || extra_.contains(QStringLiteral("x-needs-lease")); }
    bool isListed() const { return isListed_; }
    int maxValues() const { return maxValues_; }

    /// The method object of an OpenRPC document.
    QJsonObject description() const;

    /// Checks params (an object, an array by position, or undefined), completes them and runs the handler.
    /// An exception in the handler becomes an internal error of this call.
    void execute(const QJsonValue &params, Call call, const Reply &reply) const;

private:
    static QString urgentKey() { return QStringLiteral("x-urgent"); }
    static QString freshKey() { return QStringLiteral("x-fresh"); }
    Result<QJsonObject> accept(const QJsonValue &params) const;
    /// Those of a stop's parameters that are as they should be.
    QJsonObject fitting(const QJsonObject &named) const;
    QJsonObject paramsSchema() const;
    std::optional<Error> refusal(const Call &call) const;
    void warnOfAngles(const QJsonObject &params) const;

    QString commandName_;
    QString summary_;
    std::vector<Field> fields_;
    std::vector<std::pair<std::size_t, Role>> restricted_; // of those
    QJsonObject resultSchema_;
    QJsonObject exampleParams_;
    QJsonValue exampleResult_{QJsonValue::Undefined};
    QJsonObject extra_;
    AsyncHandler run_;
    Role role_ = Role::Operator;
    bool isListed_ = true;
    bool isStream_ = false;
    int maxValues_ = 3000;
    mutable std::shared_ptr<const SchemaValidator> validator_; // made at the first call
};

} // namespace hermes
