#include "gui/desktop/widgets/JsonEditor.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/FieldText.h"
#include "gui/desktop/widgets/PlainLabel.h"
#include "protocol/wire/JsonText.h"

#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonParseError>
#include <QPlainTextEdit>
#include <algorithm>
#include <utility>

namespace hermes::desktop {
namespace {

constexpr int longestJson = 100000, longestJsonLine = 2000, shownLines = 6;

/// Qt takes long for a line that has no end.
bool isShowable(const QString &text) {
    if (text.size() > longestJson)
        return false;
    const auto all = text.splitRef('\n');
    return std::none_of(all.begin(), all.end(),
                        [](const auto &line) { return line.size() > longestJsonLine; });
}

} // namespace

JsonEditor::JsonEditor(QWidget *parent)
    : ValueEditor(parent) {
    filled(this, inColumn({}));
}

/// Above the note.
void JsonEditor::show(QWidget *shown) {
    static_cast<QBoxLayout *>(layout())->insertWidget(0, shown);
    setFocusProxy(text_);
    Q_EMIT rebuilt();
}

void JsonEditor::setValue(const QJsonValue &value) {
    if (countValues(value, maxValues) > maxValues)
        return setTooLong(value);
    const QString text = value.isUndefined() ? QString() : indentedJson(value);
    if (!isShowable(text))
        return setTooLong(value);
    given_ = value;
    givenText_ = text;
    if (!text_) {
        delete tooLong_;
        text_ = new QPlainTextEdit;
        text_->setFont(theme::fixedFont());
        text_->setTabChangesFocus(true);
        text_->setFixedHeight(shownLines * text_->fontMetrics().lineSpacing() + 12);
        connect(text_, &QPlainTextEdit::textChanged, this, &ValueEditor::edited);
        show(text_);
    }
    const QSignalBlocker silence(text_);
    if (text_->toPlainText() != text)
        text_->setPlainText(text);
}

void JsonEditor::setTooLong(const QJsonValue &value) {
    given_ = value;
    delete std::exchange(text_, nullptr);
    if (!tooLong_)
        show(tooLong_ = new PlainLabel(tr("too long to be edited here")));
}

QJsonValue JsonEditor::value() const {
    if (!text_)
        return given_;
    const QString text = text_->toPlainText();
    if (text == givenText_)
        return given_;
    if (text.trimmed().isEmpty())
        return QJsonValue::Undefined;
    const QJsonValue value = fromJson(text);
    return value.isUndefined() ? QJsonValue(text) : value;
}

void JsonEditor::addFaults(const QString &path, Faults &faults) const {
    const QString text = text_ ? text_->toPlainText() : QString();
    if (text == givenText_ || text.trimmed().isEmpty())
        return;
    QJsonParseError error;
    const QByteArray list = '[' + text.toUtf8() + ']';
    QJsonDocument::fromJson(list, &error);
    if (error.error != QJsonParseError::NoError)
        faults[path] = tr("each bracket, quote and comma in its place; line %1 cannot be read")
                           .arg(1 + list.left(error.offset).count('\n'));
    else if (losesDigits(text))
        faults[path] = tr("whole numbers of at most 15 digits: more would not arrive as they are");
}

bool JsonEditor::placeNote(QWidget *note) {
    layout()->addWidget(note);
    return true;
}

} // namespace hermes::desktop
