#include "gui/desktop/widgets/ValueEditor.h"

#include "gui/desktop/Theme.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QJsonArray>
#include <QJsonDocument>
#include <QKeyEvent>
#include <QLineEdit>
#include <cmath>

namespace hermes {
namespace {

QString jsonText(const QJsonValue &value) {
    const QByteArray list = QJsonDocument(QJsonArray{value}).toJson(QJsonDocument::Compact);
    return QString::fromUtf8(list.mid(1, list.size() - 2));
}

/// Undefined: it is no JSON.
QJsonValue fromJson(const QString &text) {
    const QJsonDocument list = QJsonDocument::fromJson("[" + text.toUtf8() + "]");
    return list.array().size() == 1 ? list.array()[0] : QJsonValue(QJsonValue::Undefined);
}

QString shownText(const QJsonValue &value) {
    return value.isUndefined() ? QString() : value.isString() ? value.toString() : jsonText(value);
}

} // namespace

ValueEditor::ValueEditor(const QJsonObject &schema, QWidget *parent)
    : QWidget(parent)
    , schema_(schema)
    , type_(schema["type"].toString()) {
    auto *const layout = new QHBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    QWidget *editor = nullptr;
    if (type_ == "boolean") {
        editor = check_ = new QCheckBox;
        connect(check_, &QCheckBox::clicked, this, &ValueEditor::edited);
    } else if (schema.contains("enum")) {
        editor = choice_ = new QComboBox;
        for (const QJsonValue &allowed : schema["enum"].toArray())
            choice_->addItem(shownText(allowed), allowed);
        choice_->setCurrentIndex(-1);
        connect(choice_, QOverload<int>::of(&QComboBox::activated), this, &ValueEditor::edited);
    } else {
        editor = text_ = new QLineEdit;
        text_->setPlaceholderText(shownText(schema["default"]));
        text_->installEventFilter(this);
        connect(text_, &QLineEdit::textEdited, this, &ValueEditor::edited);
    }
    layout->addWidget(editor);
    setFocusProxy(editor);
    setValue(schema["default"]);
}

QJsonValue ValueEditor::value() const {
    if (check_)
        return check_->isChecked();
    if (choice_)
        return choice_->currentIndex() < 0 ? QJsonValue(QJsonValue::Undefined)
                                           : choice_->currentData().toJsonValue();
    const QString text = text_->text().trimmed();
    if (type_ == "string")
        return text_->text().isEmpty() && !schema_.contains("default") ? QJsonValue(QJsonValue::Undefined)
                                                                       : QJsonValue(text_->text());
    if (text.isEmpty())
        return QJsonValue::Undefined;
    const QJsonValue value = fromJson(text);
    return value.isUndefined() ? QJsonValue(text) : value;
}

void ValueEditor::setValue(const QJsonValue &value) {
    if (check_)
        check_->setChecked(value.toBool());
    else if (choice_)
        choice_->setCurrentIndex(choice_->findText(shownText(value), Qt::MatchExactly));
    else if (text_->text() != shownText(value))
        text_->setText(shownText(value));
}

void ValueEditor::setWrong(bool isWrong) {
    QPalette palette;
    if (isWrong)
        palette.setColor(QPalette::Text, theme::colour(Condition::Fault));
    focusProxy()->setPalette(palette);
}

bool ValueEditor::eventFilter(QObject *watched, QEvent *event) {
    const bool isNumber = type_ == "number" || type_ == "integer";
    if (isNumber && event->type() == QEvent::KeyPress) {
        const int key = static_cast<QKeyEvent *>(event)->key();
        if (key == Qt::Key_Up || key == Qt::Key_Down) {
            step(key == Qt::Key_Up ? 1 : -1);
            return true;
        }
    }
    return QWidget::eventFilter(watched, event);
}

void ValueEditor::step(int count) {
    const QJsonValue now = value().isUndefined() ? schema_["default"] : value();
    if (!now.isDouble() && !now.isUndefined())
        return;
    const double increment = schema_["multipleOf"].toDouble(type_ == "integer" ? 1 : 0.1);
    const double next = std::round(now.toDouble() / increment + count) * increment;
    setValue(qBound(schema_["minimum"].toDouble(next), next, schema_["maximum"].toDouble(next)));
    Q_EMIT edited();
}

} // namespace hermes
