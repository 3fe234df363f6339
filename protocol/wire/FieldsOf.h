#pragma once

class QJsonObject;
class QJsonValue;

namespace hermes {

template <typename T>
class Fields;

/// Names a type. Beside each struct T that travels stands `Fields<T> fieldsOf(Of<T>)`, its fields.
/// Whoever writes, reads or describes it includes Fields.h.
template <typename T>
struct Of {};

/// How a value of the type T is written, read and described.
template <typename T, typename = void>
struct Type;

/// The JSON Schema of T.
template <typename T>
QJsonObject schemaOf();

/// A value of the type T as JSON.
template <typename T>
QJsonValue asJson(const T &value);

} // namespace hermes
