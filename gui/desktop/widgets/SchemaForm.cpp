#include "gui/desktop/widgets/SchemaForm.h"

#include "common/schema/CheckableSchema.h"
#include "common/schema/SchemaText.h"
#include "common/settings/DottedPath.h"
#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/PlainLabel.h"
#include "gui/desktop/widgets/ValueEditor.h"

#include <QGridLayout>
#include <QRegularExpression>
#include <QSet>
#include <QVBoxLayout>
#include <algorithm>

namespace hermes::desktop {
namespace {

enum Column { TitleColumn, EditorColumn, UnitColumn, NoteColumn };

constexpr int longestTitle = 60, longestUnit = 20, longestNote = 120;
constexpr int mostSteps = 10000; // of a check, which runs with each key

/// The title, or words made of the path: "safety.command_timeout_s" in "s" reads "command timeout".
QString titleOf(const QString &path, const QJsonObject &schema) {
    const QString title = schema["title"].toString();
    if (!title.isEmpty())
        return title;
    QStringList words = path.section('.', path.contains('.') ? 1 : 0).split(QRegularExpression("[._]"));
    static const QSet<QString> units{"s", "m", "v", "a", "c", "b", "mps", "rps", "hz", "deg", "bytes"};
    if (schema.contains("unit") && words.size() > 1 && units.contains(words.back()))
        words.removeLast();
    return words.join(' ');
}

QString limitsOf(const QJsonObject &schema) {
    const QJsonValue least = schema["minimum"], most = schema["maximum"];
    if (least.isDouble() && most.isDouble())
        return SchemaForm::tr("%1 to %2").arg(least.toDouble()).arg(most.toDouble());
    if (least.isDouble())
        return SchemaForm::tr("at least %1").arg(least.toDouble());
    return most.isDouble() ? SchemaForm::tr("at most %1").arg(most.toDouble()) : QString();
}

QString explanation(const QString &path, const QJsonObject &schema) {
    QStringList lines{schema["description"].toString(), path + ": " + expectation(schema)};
    if (schema.contains("default"))
        lines.append(SchemaForm::tr("default %1").arg(shown(schema["default"])));
    if (schema["x-applies"].toString() == "restart")
        lines.append(SchemaForm::tr("has effect after a restart"));
    return lines.join('\n');
}

} // namespace

SchemaForm::SchemaForm(QWidget *parent)
    : QWidget(parent)
    , notice_(new PlainLabel) {
    auto *const column = new QVBoxLayout(this);
    column->addWidget(notice_);
    notice_->setObjectName("notice");
    notice_->setWordWrap(true);
    notice_->setMinimumWidth(1);
    QPalette warning;
    warning.setColor(QPalette::WindowText, theme::colour(Condition::Warning));
    notice_->setPalette(warning);
}

void SchemaForm::setSchema(const QJsonObject &schema, const QJsonObject &values) {
    delete page_;
    page_ = new QWidget;
    rows_.clear();
    order_.clear();
    headings_.clear();
    errors_.clear();
    schema_ = schema;
    baseline_ = values;
    unshown_ = 0;
    addRows(schema, {});
    prepareCheck();
    arrange();
    revert();
    layout()->addWidget(page_); // laid out once, when it is whole
}

void SchemaForm::addRows(const QJsonObject &schema, const QString &prefix) {
    const QJsonObject properties = schema["properties"].toObject();
    for (auto property = properties.begin(); property != properties.end(); ++property) {
        const QString path = prefix.isEmpty() ? property.key() : prefix + "." + property.key();
        const QJsonObject inner = property.value().toObject();
        if (inner["properties"].isObject())
            addRows(inner, path);
        else if (int(order_.size()) < mostRows && rows_.count(path) == 0)
            addRow(path, inner);
        else
            ++unshown_;
    }
}

void SchemaForm::prepareCheck() {
    validator_.reset();
    hindrance_.clear();
    if (unshown_ > 0) {
        hindrance_ = tr("%1 more values are not shown").arg(unshown_);
    } else if (auto made = SchemaValidator::make(schema_)) {
        validator_.emplace(made.take());
    } else {
        hindrance_ = made.error().message;
    }
}

void SchemaForm::addRow(const QString &path, const QJsonObject &schema) {
    Row row;
    row.schema = schema;
    row.group = schema["group"].toString();
    if (row.group.isEmpty())
        row.group = path.contains('.') ? path.section('.', 0, 0) : QString();
    row.title = new PlainLabel(shortLine(titleOf(path, schema), longestTitle).replace('&', "&&"));
    row.editor = new ValueEditor(schema);
    row.editor->setObjectName(path);
    row.title->setBuddy(row.editor);
    row.note = new PlainLabel;
    row.note->setObjectName(path + "/note");
    row.widgets = {row.title, row.editor, new PlainLabel(shortLine(schema["unit"].toString(), longestUnit)),
                   row.note};
    const QString toolTip = toolTipOf(explanation(path, schema));
    for (QWidget *widget : row.widgets)
        widget->setToolTip(toolTip);
    connect(row.editor, &ValueEditor::edited, this, [this, path] {
        errors_.erase(path);
        check();
        Q_EMIT edited();
    });
    rows_.emplace(path, row);
    order_.push_back(path);
}

// Groups in the order of their first row, rows within as the schema has them.
void SchemaForm::arrange() {
    std::vector<QString> groups;
    for (const QString &path : order_)
        if (const QString &group = rows_.at(path).group;
            std::find(groups.begin(), groups.end(), group) == groups.end())
            groups.push_back(group);
    auto *const grid = new QGridLayout(page_);
    grid->setContentsMargins({});
    grid->setColumnStretch(EditorColumn, 2);
    grid->setColumnStretch(NoteColumn, 3);
    grid->setVerticalSpacing(4);
    int line = 0;
    for (const QString &group : groups) {
        auto *const heading = new PlainLabel(shortLine(group, longestTitle));
        heading->setBold(true);
        headings_.push_back(heading);
        grid->addWidget(heading, line++, 0, 1, 4);
        heading->setVisible(!group.isEmpty());
        for (const QString &path : order_)
            if (const Row &row = rows_.at(path); row.group == group) {
                for (int column = 0; column < int(row.widgets.size()); ++column)
                    grid->addWidget(row.widgets[size_t(column)], line, column);
                ++line;
            }
    }
    grid->setRowStretch(line, 1);
    QWidget *before = nullptr;
    for (const QString &path : order_) {
        if (before)
            setTabOrder(before, rows_.at(path).editor);
        before = rows_.at(path).editor;
    }
}

void SchemaForm::setBaseline(const QJsonObject &values) {
    const QJsonObject before = std::exchange(baseline_, values);
    for (auto &[path, row] : rows_)
        if (row.editor->value() == valueAt(before, path))
            row.editor->setValue(valueAt(values, path));
    check();
}

void SchemaForm::setDefaults() {
    for (auto &[path, row] : rows_)
        row.editor->setValue(row.schema["default"]);
    errors_.clear();
    check();
    Q_EMIT edited();
}

void SchemaForm::revert() {
    for (auto &[path, row] : rows_)
        if (const QJsonValue value = valueAt(baseline_, path); !value.isUndefined())
            row.editor->setValue(value);
    errors_.clear();
    check();
}

void SchemaForm::edit(const QJsonObject &changes) {
    for (auto &[path, row] : rows_)
        if (const QJsonValue value = valueAt(changes, path); !value.isUndefined())
            row.editor->setValue(value);
    check();
    Q_EMIT edited();
}

QJsonObject SchemaForm::values() const {
    QJsonObject result;
    for (const auto &[path, row] : rows_)
        if (const QJsonValue value = row.editor->value(); !value.isUndefined())
            result = withValueAt(result, path, value);
    return result;
}

QJsonObject SchemaForm::changes() const {
    return difference(values(), baseline_);
}

void SchemaForm::showErrors(const QJsonArray &errors) {
    for (const QJsonValue &error : errors)
        errors_[error["path"].toString()] = error["expected"].toString();
    markAll();
}

void SchemaForm::check() {
    errors_.clear();
    const QJsonObject now = values();
    const bool isCheap = isCheapToCheck(schema_, now, mostSteps);
    if (validator_ && isCheap)
        for (const SchemaViolation &violation : validator_->check(now))
            errors_[violation.path] = violation.expected;
    if (validator_)
        hindrance_ = isCheap ? QString() : tr("there are too many values");
    for (const auto &[path, row] : rows_) // what has a value cannot be left without one
        if (row.editor->value().isUndefined() && !valueAt(baseline_, path).isUndefined())
            errors_[path] = expectation(row.schema);
    markAll();
}

bool SchemaForm::hasRow(const QString &path) const {
    for (QString place = path; !place.isEmpty(); place.truncate(qMax(0, place.lastIndexOf('.'))))
        if (rows_.count(place.section('[', 0, 0)) > 0)
            return true;
    return false;
}

void SchemaForm::markAll() {
    for (auto &[path, row] : rows_)
        mark(path, row);
    QStringList lines;
    if (!hindrance_.isEmpty())
        lines.append(tr("The values cannot be checked here: %1").arg(hindrance_));
    for (const auto &[path, expected] : errors_)
        if (lines.size() < 5 && !hasRow(path))
            lines.append(tr("%1: expected %2").arg(path.isEmpty() ? tr("all together") : path, expected));
    notice_->setText(lines.join('\n'));
    notice_->setVisible(!lines.isEmpty());
}

void SchemaForm::mark(const QString &path, Row &row) {
    // An array's element that is wrong is a mistake of the array.
    auto error = errors_.find(path);
    for (const char *const inner : {".", "["})
        if (const auto next = errors_.lower_bound(path + inner);
            error == errors_.end() && next != errors_.end() && next->first.startsWith(path + inner))
            error = next;
    const bool isWrong = error != errors_.end();
    const QJsonValue before = valueAt(baseline_, path);
    const bool isChanged = row.editor->value() != (before.isUndefined() ? row.schema["default"] : before);
    const bool needsRestart = row.schema["x-applies"].toString() == "restart";
    row.editor->setWrong(isWrong);
    QString note = isWrong                     ? tr("expected %1").arg(error->second)
                   : isChanged && needsRestart ? tr("changed, needs a restart")
                   : isChanged                 ? tr("changed")
                                               : limitsOf(row.schema);
    row.note->setText(shortLine(note, longestNote));
    QPalette palette;
    if (isWrong || isChanged)
        palette.setColor(QPalette::WindowText, theme::colour(isWrong ? Condition::Fault : Condition::Busy));
    row.note->setPalette(palette);
}

void SchemaForm::setFilter(const QString &text) {
    for (auto &[path, row] : rows_) {
        const bool isShown = text.isEmpty() || path.contains(text, Qt::CaseInsensitive) ||
                             row.title->text().contains(text, Qt::CaseInsensitive) ||
                             row.schema["description"].toString().contains(text, Qt::CaseInsensitive);
        for (QWidget *widget : row.widgets)
            widget->setVisible(isShown);
    }
    for (PlainLabel *heading : headings_)
        heading->setVisible(text.isEmpty() && !heading->text().isEmpty());
}

} // namespace hermes::desktop
