#pragma once

#include <QJsonObject>
#include <QString>

namespace hermes {

/// A JSON Schema in the form in which it can be checked here.
struct CheckableSchema {
    /// For valijson: integers as numbers (it takes those of 32 bits only), without `pattern` (its expressions
    /// recurse without bound) and `format`.
    QJsonObject schema;
    /// Why the schema cannot be checked in bounded time and stack: the first keyword that hinders, and where.
    QString problem;
};

CheckableSchema checkable(const QJsonObject &schema);

/// Whether a check of the value takes no more than so many steps.
bool isCheapToCheck(const QJsonObject &schema, const QJsonValue &value, int steps);

} // namespace hermes
