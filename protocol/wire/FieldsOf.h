#pragma once

class QJsonObject;

namespace hermes {

template <typename T>
class Fields;

/// Names a type. Beside each struct T that travels stands `const Fields<T> &fieldsOf(Of<T>)`, its fields.
/// Whoever writes, reads or describes it includes Fields.h.
template <typename T>
struct Of {};

/// How a value of the type T is written, read and described.
template <typename T, typename = void>
struct Type;

/// The JSON Schema of T.
template <typename T>
QJsonObject schemaOf();

} // namespace hermes
