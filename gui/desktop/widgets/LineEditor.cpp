#include "gui/desktop/widgets/LineEditor.h"

#include "gui/desktop/widgets/FieldText.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QDateTime>
#include <QHostAddress>
#include <QJsonArray>
#include <QKeyEvent>
#include <QLineEdit>
#include <QRegularExpression>
#include <QUrl>
#include <algorithm>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr int longestEdited = 10000;

/// One that has the format, to be seen where nothing is typed; empty: the format is not known here.
QString exampleOf(const QString &format) {
    static const QMap<QString, QString> examples{{"date-time", "2026-01-31T12:00:00Z"},
                                                 {"date", "2026-01-31"},
                                                 {"ipv4", "192.168.1.20"},
                                                 {"ipv6", "fe80::1"},
                                                 {"uri", "https://example.org/a"}};
    return examples.value(format);
}

bool hasFormat(const QString &text, const QString &format) {
    if (format == "date-time")
        return QDateTime::fromString(text, Qt::ISODate).isValid() && text.contains('T');
    if (format == "date")
        return QDate::fromString(text, Qt::ISODate).isValid();
    if (format == "ipv4" || format == "ipv6") {
        QHostAddress address;
        return address.setAddress(text) &&
               (address.protocol() == QAbstractSocket::IPv4Protocol) == (format == "ipv4");
    }
    if (format == "uri") {
        const QUrl url(text, QUrl::StrictMode);
        return url.isValid() && !url.isRelative();
    }
    return true;
}

/// "1, 2.5 3"; what is no number stays a text in the list, so that the schema refuses it.
QJsonArray numbersIn(QString text) {
    QJsonArray list;
    text.remove('[').remove(']');
    for (const QString &word : text.split(QRegularExpression("[\\s,;]+"), Qt::SkipEmptyParts)) {
        const QJsonValue value = fromJson(word);
        list.append(value.isDouble() ? value : QJsonValue(word));
    }
    return list;
}

/// A hundredth to a tenth of what is usual, as a power of ten.
double usualStep(const QJsonObject &schema, double now) {
    const double given = schema["increment"].toDouble(schema["multipleOf"].toDouble());
    if (given > 0)
        return given;
    if (schema["type"] == "integer")
        return 1;
    const double usual = std::abs(schema["default"].toDouble(now));
    return usual > 0 ? std::pow(10, std::floor(std::log10(usual) + 1e-9) - 1) : 0.1;
}

} // namespace

LineEditor::LineEditor(const QJsonObject &schema, Kind kind, Empty empty, QWidget *parent)
    : ValueEditor(parent)
    , schema_(schema)
    , kind_(kind)
    , empty_(empty)
    , line_(new QLineEdit) {
    hold(line_);
    const QString example = exampleOf(schema["format"].toString());
    if (isSecret(schema))
        line_->setEchoMode(QLineEdit::Password);
    line_->setPlaceholderText(
        schema.contains("default") && !isSecret(schema) ? shortLine(textOf(schema["default"])) : example);
    line_->installEventFilter(this);
    connect(line_, &QLineEdit::textEdited, this, &ValueEditor::edited);
    setValue(schema["default"]);
}

QString LineEditor::textOf(const QJsonValue &value) const {
    if (value.isUndefined())
        return {};
    if (value.isDouble())
        return numberText(value.toDouble());
    if (kind_ == Kind::Numbers && value.isArray()) {
        QStringList words;
        for (const QJsonValue &number : value.toArray())
            words.append(number.isDouble() ? numberText(number.toDouble()) : jsonText(number));
        return words.join(", ");
    }
    if (!value.isString())
        return jsonText(value);
    const QString text = value.toString();
    const bool readsOtherwise =
        kind_ == Kind::Any && (text != text.trimmed() || text.isEmpty() || !fromJson(text).isUndefined());
    return readsOtherwise ? jsonText(value) : text; // "5" is no 5
}

QJsonValue LineEditor::value() const {
    return line_->text() == givenText_ ? given_ : typed();
}

QJsonValue LineEditor::typed() const {
    const QString text = line_->text().trimmed();
    const bool isEmptyAbsent = empty_ == Empty::Absent && !schema_.contains("default");
    if (kind_ == Kind::Text)
        return line_->text().isEmpty() && isEmptyAbsent ? QJsonValue(QJsonValue::Undefined)
                                                        : QJsonValue(line_->text());
    if (kind_ == Kind::Numbers)
        return text.isEmpty() && isEmptyAbsent ? QJsonValue(QJsonValue::Undefined)
                                               : QJsonValue(numbersIn(text));
    if (text.isEmpty())
        return QJsonValue::Undefined;
    const QJsonValue value = fromJson(text);
    return value.isUndefined() ? QJsonValue(text) : value;
}

void LineEditor::setValue(const QJsonValue &value) {
    given_ = value;
    const QString text = countValues(value, longestEdited) > longestEdited ? QString() : textOf(value);
    const bool isLong =
        text.size() > longestEdited || (text.isEmpty() && value.isArray() && !value.toArray().isEmpty());
    line_->setReadOnly(isLong);
    const QString shown = isLong ? tr("too long to be edited here: %1").arg(shortLine(text)) : text;
    if (line_->text() != shown)
        line_->setText(shown);
    givenText_ = line_->text(); // of which the line has cut what it cannot show
}

void LineEditor::addFaults(const QString &path, Faults &faults) const {
    const QString text = line_->text().trimmed(), format = schema_["format"].toString();
    const QString example = exampleOf(format);
    if (kind_ == Kind::Text && !text.isEmpty() && !example.isEmpty() && !hasFormat(text, format))
        faults[path] = tr("one like %1").arg(example);
    if (kind_ == Kind::Any && (text.startsWith('{') || text.startsWith('[')) && value().isString() &&
        line_->text() != givenText_)
        faults[path] = tr("each bracket and quote to be closed");
    if (kind_ != Kind::Text && line_->text() != givenText_ && losesDigits(text))
        faults[path] = tr("at most 15 digits: more would not arrive as they are");
}

bool LineEditor::eventFilter(QObject *watched, QEvent *event) {
    if (kind_ == Kind::Number && event->type() == QEvent::KeyPress) {
        static const QMap<int, int> steps{
            {Qt::Key_Up, 1}, {Qt::Key_Down, -1}, {Qt::Key_PageUp, 10}, {Qt::Key_PageDown, -10}};
        if (const int count = steps.value(static_cast<QKeyEvent *>(event)->key())) {
            step(count);
            return true;
        }
    }
    return ValueEditor::eventFilter(watched, event);
}

void LineEditor::step(int count) {
    const QJsonValue now = value().isUndefined() ? schema_["default"] : value();
    if ((!now.isDouble() && !now.isUndefined()) || line_->isReadOnly())
        return;
    const double increment = usualStep(schema_, now.toDouble());
    double next = std::round(now.toDouble() / increment + count) * increment;
    next = std::min(next, schema_["maximum"].toDouble(next));
    next = std::max(next, schema_["minimum"].toDouble(next));
    line_->setText(numberText(next));
    Q_EMIT edited();
}

} // namespace hermes::desktop
