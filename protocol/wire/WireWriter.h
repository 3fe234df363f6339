#pragma once

#include <QJsonValue>
#include <QString>
#include <cmath>
#include <cstddef>

namespace hermes {

/// Where a message is written to, value after value, in whatever form the wire has. A number that is NaN or
/// infinite cannot be written: the message is refused, and refused() tells where it stands.
class WireWriter {
public:
    virtual ~WireWriter() = default;

    virtual void beginObject() = 0;
    virtual void key(const QString &name) = 0; ///< before each value of an object
    virtual void endObject() = 0;
    virtual void beginArray() = 0;
    virtual void endArray() = 0;

    virtual void null() = 0;
    virtual void boolean(bool value) = 0;
    virtual void integer(qint64 value) = 0;
    virtual void text(const QString &value) = 0;
    void number(double value) { std::isfinite(value) ? finite(value) : refuse(); }
    /// The shortest decimal fraction that a reader of floats takes for the same.
    void number(float value) { std::isfinite(value) ? finite(value) : refuse(); }
    /// An array of them: packed where the wire has that.
    virtual void numbers(const float *values, std::size_t count);
    virtual void numbers(const double *values, std::size_t count);
    virtual void numbers(const quint8 *values, std::size_t count);
    virtual void numbers(const quint16 *values, std::size_t count);
    /// What cannot be written is null; the first of it is refused.
    void json(const QJsonValue &value);

    bool hasRefused() const { return isRefused_; }
    /// The dotted path of the first number that could not be written; "" is the message itself.
    const QString &refused() const { return path_; }
    /// Whoever wrote a member or an element that was refused says which.
    void within(const QString &name) { path_ = path_.isEmpty() ? name : name + QLatin1Char('.') + path_; }

protected:
    virtual void finite(double value) = 0;
    virtual void finite(float value) = 0;

private:
    void json(const QJsonValue &value, const QString &name);
    void refuse() {
        isRefused_ = true;
        null();
    }
    template <typename T>
    void each(const T *values, std::size_t count);

    bool isRefused_ = false;
    QString path_;
};

} // namespace hermes
