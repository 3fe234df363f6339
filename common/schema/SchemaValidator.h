#pragma once

#include "common/Result.h"

#include <QJsonArray>
#include <QJsonObject>
#include <QString>
#include <memory>
#include <vector>

namespace hermes {

/// One thing that a value has wrong: where, what stands there, what was expected.
struct SchemaViolation {
    QString path;                            ///< dotted, "" for the value itself
    QJsonValue value{QJsonValue::Undefined}; ///< undefined where something is missing
    QString expected;

    /// "motor.radius is 7, expected a number from 0 to 1 in m"
    QString toString() const;
    /// {path, value, expected}; value is absent where something is missing.
    QJsonObject toJson() const;
};

/// A JSON Schema made ready to check values against.
class SchemaValidator {
public:
    /// Of a schema of one's own: a wrong one is an exception.
    explicit SchemaValidator(const QJsonObject &schema);
    /// Of a schema that came from elsewhere. Error: why it cannot be checked.
    static Result<SchemaValidator> make(const QJsonObject &schema);
    ~SchemaValidator();
    SchemaValidator(SchemaValidator &&) noexcept;
    SchemaValidator &operator=(SchemaValidator &&) noexcept;

    /// Everything wrong with the value, none when it is as the schema says.
    std::vector<SchemaViolation> check(const QJsonValue &value) const;

private:
    struct Compiled;
    std::unique_ptr<Compiled> compiled_;
};

/// All violations as one text, separated by "; ".
QString toString(const std::vector<SchemaViolation> &violations);
QJsonArray toJson(const std::vector<SchemaViolation> &violations);
/// InvalidParams with all violations in `data.errors`; the message is theirs where none is given.
Error invalidParams(const std::vector<SchemaViolation> &violations, const QString &message = QString());

} // namespace hermes
