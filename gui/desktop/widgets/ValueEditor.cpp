#include "gui/desktop/widgets/ValueEditor.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QJsonArray>
#include <QJsonDocument>
#include <QKeyEvent>
#include <QLineEdit>
#include <algorithm>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr int longestText = 10000, longestChoice = 100, mostChoices = 1000;

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
    } else if (const QJsonArray choices = schema["enum"].toArray();
               !choices.isEmpty() && choices.size() <= mostChoices) {
        editor = choice_ = new QComboBox;
        choice_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
        for (const QJsonValue &allowed : choices)
            choice_->addItem(shortLine(shownText(allowed), longestChoice), allowed);
        choice_->setCurrentIndex(-1);
        connect(choice_, QOverload<int>::of(&QComboBox::activated), this, &ValueEditor::edited);
    } else {
        editor = text_ = new QLineEdit;
        text_->setPlaceholderText(shortLine(shownText(schema["default"])));
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
    if (!longValue_.isUndefined())
        return longValue_;
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
        choose(value);
    else
        showText(value);
}

void ValueEditor::choose(const QJsonValue &value) {
    const QJsonArray choices = schema_["enum"].toArray();
    const auto found = std::find(choices.begin(), choices.end(), value);
    choice_->setCurrentIndex(found == choices.end() ? -1 : int(found - choices.begin()));
}

void ValueEditor::showText(const QJsonValue &value) {
    const QString text = shownText(value);
    const bool isLong = text.size() > longestText;
    longValue_ = isLong ? value : QJsonValue(QJsonValue::Undefined);
    text_->setReadOnly(isLong);
    const QString shown = isLong ? tr("too long to be edited here: %1").arg(shortLine(text)) : text;
    if (text_->text() != shown)
        text_->setText(shown);
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
    double increment = schema_["increment"].toDouble(schema_["multipleOf"].toDouble());
    if (!(increment > 0))
        increment = type_ == "integer" ? 1 : 0.1;
    const double next = std::round(now.toDouble() / increment + count) * increment;
    setValue(qBound(schema_["minimum"].toDouble(next), next, schema_["maximum"].toDouble(next)));
    Q_EMIT edited();
}

} // namespace hermes::desktop
