#pragma once

#include <QByteArray>
#include <QJsonValue>
#include <QString>
#include <optional>

namespace hermes {

/// What is wrong with a JSON text, and where.
struct JsonTextError {
    QString message;
    int offset = 0; ///< byte, from 0
    int line = 1;   ///< from 1
};

/// Strict JSON parsing on top of Qt's parser: any value may stand at the top, bytes must be UTF-8, a key
/// may occur once in an object, nesting is limited to maximumDepth. Gives the value or sets error.
std::optional<QJsonValue> parseJson(const QByteArray &text, JsonTextError *error, int maximumDepth = 100);

/// One value as compact JSON on one line (an undefined value gives "null").
QByteArray compactJson(const QJsonValue &value);

/// The dotted path of the first number in value that is NaN or infinite, which JSON cannot carry ("" is the
/// value itself); nothing when all are finite.
std::optional<QString> findNonFinite(const QJsonValue &value);

} // namespace hermes
