#include "gui/desktop/widgets/SchemaForm.h"

#include "common/schema/CheckableSchema.h"
#include "common/schema/SchemaText.h"
#include "common/settings/DottedPath.h"
#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/EditorFactory.h"
#include "gui/desktop/widgets/FieldText.h"
#include "gui/desktop/widgets/PlainLabel.h"

#include <QGridLayout>
#include <algorithm>
#include <set>

namespace hermes::desktop {
namespace {

constexpr int roomy = 700; // pixels: there is room for descriptions

constexpr int maxSteps = 10000; // of a check, which runs with each key

/// As the window writes paths: "a.0.b" for "a[0].b".
QString dotted(QString path) {
    return path.replace('[', '.').remove(']');
}

/// A group of values: each of them has one to begin with.
bool isGroup(const QJsonObject &schema) {
    if (!schema["properties"].isObject() || schema.contains("default"))
        return false;
    const QJsonObject properties = schema["properties"].toObject();
    return std::all_of(properties.begin(), properties.end(), [](const QJsonValue &property) {
        return property.toObject().contains("default") || isGroup(property.toObject());
    });
}

QLabel *makeDescription(const QJsonObject &schema) {
    auto *const label = named(new PlainLabel(shortLine(schema["description"].toString())), "description");
    label->letElide();
    label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    label->setForegroundRole(QPalette::PlaceholderText);
    return label;
}

} // namespace

SchemaForm::SchemaForm(QWidget *parent)
    : QWidget(parent)
    , notice_(named(new PlainLabel, "notice")) {
    setLayout(inColumn({notice_}));
    notice_->letWrap();
    theme::tint(*notice_, QPalette::WindowText, Condition::Warning);
}

void SchemaForm::setSchema(const QJsonObject &schema, const QJsonObject &values) {
    delete page_;
    page_ = new QWidget;
    room_ = std::make_shared<EditorRoom>();
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
        if (isGroup(inner))
            addRows(inner, path);
        else if (int(order_.size()) < maxRows && rows_.count(path) == 0)
            addRow(path, inner, schema["required"].toArray().contains(property.key()));
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

void SchemaForm::addRow(const QString &path, const QJsonObject &schema, bool isRequired) {
    Row row;
    row.schema = schema;
    row.group = schema["group"].toString();
    if (row.group.isEmpty())
        row.group = path.contains('.') ? path.section('.', 0, 0) : QString();
    row.title = new PlainLabel(labelText(shortLine(titleOf(path, schema), longestTitle)));
    const bool isOptional =
        !isRequired && !schema.contains("default") && valueAt(baseline_, path).isUndefined();
    row.editor = makeEditor(schema, {room_, 0, isOptional, LineEditor::Empty::Absent});
    row.editor->setObjectName(path);
    row.editor->setEnabled(!schema["readOnly"].toBool());
    row.title->setBuddy(row.editor);
    row.note = named(new PlainLabel, path + "/note");
    row.widgets = {row.title, row.editor, row.note};
    row.isWide = row.editor->placeNote(row.note);
    if (!row.isWide)
        row.widgets.push_back(row.unit = new PlainLabel(shownUnit(schema)));
    row.widgets.push_back(row.description = makeDescription(schema));
    const QString toolTip = toolTipOf(explanation(path, schema));
    for (QWidget *widget : row.widgets)
        widget->setToolTip(toolTip);
    connect(row.editor, &ValueEditor::edited, this, [this] {
        check();
        Q_EMIT edited();
    });
    connect(row.editor, &ValueEditor::rebuilt, this, &SchemaForm::chainRows);
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
    grid->setColumnStretch(NoteColumn, 2);
    grid->setVerticalSpacing(4);
    int line = 0;
    for (const QString &group : groups) {
        auto *const heading = named(new PlainLabel(shortLine(group, longestTitle)), "heading");
        heading->setBold(true);
        headings_.emplace_back(heading, group);
        grid->addWidget(heading, line++, 0, 1, 5);
        heading->setVisible(!group.isEmpty());
        for (const QString &path : order_)
            if (const Row &row = rows_.at(path); row.group == group)
                place(row, *grid, line++);
    }
    grid->setRowStretch(line, 1);
    giveRoom();
    chainRows();
}

void SchemaForm::giveRoom() {
    if (auto *const grid = page_ ? static_cast<QGridLayout *>(page_->layout()) : nullptr)
        grid->setColumnStretch(DescriptionColumn, width() < roomy ? 0 : 3);
}

void SchemaForm::resizeEvent(QResizeEvent *event) {
    QWidget::resizeEvent(event);
    giveRoom();
}

void SchemaForm::place(const Row &row, QGridLayout &grid, int line) {
    if (row.isWide) {
        row.title->setMargin(3); // as high as its first row
        grid.addWidget(row.title, line, TitleColumn, Qt::AlignTop);
        grid.addWidget(row.editor, line, EditorColumn, 1, 3);
        grid.addWidget(row.description, line, DescriptionColumn, Qt::AlignTop);
        return;
    }
    grid.addWidget(row.description, line, DescriptionColumn);
    grid.addWidget(row.title, line, TitleColumn);
    grid.addWidget(row.editor, line, EditorColumn);
    grid.addWidget(row.unit, line, UnitColumn);
    grid.addWidget(row.note, line, NoteColumn);
}

void SchemaForm::chainRows() {
    QWidgetList all;
    for (const QString &path : order_)
        all += rows_.at(path).editor->focusOrder();
    chainFocus(all);
}

void SchemaForm::setBaseline(const QJsonObject &values) {
    const QJsonObject before = std::exchange(baseline_, values);
    for (auto &[path, row] : rows_)
        if (row.editor->value() == valueAt(before, path))
            row.editor->setValue(valueAt(values, path));
    check();
}

QString SchemaForm::firstError() const {
    if (errors_.empty())
        return {};
    const auto &[path, expected] = *errors_.begin();
    return tr("%1: expected %2").arg(path.isEmpty() ? tr("all together") : path, expected);
}

void SchemaForm::setDefaults() {
    for (auto &[path, row] : rows_)
        if (row.isInSight && !row.schema["readOnly"].toBool())
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

int SchemaForm::unseenChanges() const {
    int count = 0;
    for (const QString &path : leafPaths(changes()))
        for (QString place = path; !place.isEmpty(); place.truncate(qMax(0, place.lastIndexOf('.'))))
            if (const auto row = rows_.find(place); row != rows_.end()) {
                count += row->second.isInSight ? 0 : 1;
                break;
            }
    return count;
}

void SchemaForm::showErrors(const QJsonArray &errors) {
    for (const QJsonValue &error : errors)
        errors_[dotted(error["path"].toString())] = error["expected"].toString();
    markAll();
}

void SchemaForm::check() {
    errors_.clear();
    const QJsonObject now = values();
    const bool isCheap = isCheapToCheck(schema_, now, maxSteps);
    if (validator_ && isCheap)
        for (const SchemaViolation &violation : validator_->check(now))
            errors_[dotted(violation.path)] = violation.expected;
    if (validator_)
        hindrance_ = isCheap ? QString() : tr("there are too many values");
    for (const auto &[path, row] : rows_) // what has a value cannot be left without one
        if (row.editor->value().isUndefined() && !valueAt(baseline_, path).isUndefined())
            errors_[path] = expectation(row.schema);
    for (const auto &[path, row] : rows_)
        row.editor->addFaults(path, errors_);
    markAll();
}

bool SchemaForm::hasRow(const QString &path) const {
    for (QString place = path; !place.isEmpty(); place.truncate(qMax(0, place.lastIndexOf('.'))))
        if (rows_.count(place) > 0)
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
    const QString fault = faultText(errors_, path, row.schema);
    const QJsonValue before = valueAt(baseline_, path), now = row.editor->value();
    const bool isChanged = now != (before.isUndefined() ? row.schema["default"] : before);
    const bool needsRestart = row.schema["x-applies"].toString() == "restart";
    row.editor->showFaults(path, errors_);
    QString note = !fault.isEmpty()            ? fault
                   : isChanged && needsRestart ? tr("changed, needs a restart")
                   : isChanged                 ? tr("changed")
                                               : limitsOf(row.schema);
    if (const QString spoken = spokenAmount(now.toDouble(), row.schema["unit"].toString()); !spoken.isEmpty())
        note = tr("%1 (%2)").arg(spoken, note);
    row.note->setText(shortLine(note, longestNote));
    std::optional<Condition> condition = theme::faultIf(!fault.isEmpty());
    if (!condition && isChanged)
        condition = Condition::Busy;
    theme::tint(*row.note, QPalette::WindowText, condition);
}

void SchemaForm::setFilter(const QString &text) {
    std::set<QString> groups;
    for (auto &[path, row] : rows_) {
        row.isInSight = text.isEmpty() || path.contains(text, Qt::CaseInsensitive) ||
                        row.title->text().contains(text, Qt::CaseInsensitive) ||
                        row.schema["description"].toString().contains(text, Qt::CaseInsensitive);
        for (QWidget *widget : row.widgets)
            widget->setVisible(row.isInSight);
        if (row.isInSight)
            groups.insert(row.group);
    }
    for (const auto &[heading, group] : headings_)
        heading->setVisible(groups.count(group) > 0 && !group.isEmpty());
}

} // namespace hermes::desktop
