#include "gui/desktop/widgets/ListEditor.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/FieldText.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QJsonArray>
#include <QPushButton>
#include <QToolButton>

namespace hermes::desktop {
namespace {

bool isStructure(const QJsonObject &schema) {
    const bool isNumbers = schema["type"] == "array" &&
                           QStringList{"number", "integer"}.contains(schema["items"]["type"].toString());
    return schema["properties"].isObject() || schema["type"] == "object" ||
           (schema["type"] == "array" && !isNumbers);
}

/// What a new element begins with.
QJsonValue beginning(const QJsonObject &item) {
    if (item.contains("default"))
        return item["default"];
    if (item["type"] == "boolean")
        return false;
    if (item["type"] == "array")
        return QJsonArray();
    return isStructure(item) ? QJsonValue(QJsonObject()) : QJsonValue(QJsonValue::Undefined);
}

} // namespace

ListEditor::ListEditor(const QJsonObject &schema, const EditorPlace &place, QWidget *parent)
    : ValueEditor(parent)
    , schema_(schema)
    , item_(schema["items"].toObject())
    , place_(place)
    , foldsOut_(isStructure(item_))
    , add_(named(new QPushButton(theme::icon("add"), tr("Add")), "add", tr("Adds a row at the end")))
    , lines_(inColumn({}))
    , foot_(inRow({add_, Part::room()})) {
    filled(this, inColumn({lines_, foot_}), 2);
    lines_->setSpacing(2);
    setFocusProxy(add_);
    connect(add_, &QPushButton::clicked, this, &ListEditor::add);
}

ListEditor::~ListEditor() = default;

int ListEditor::indexOf(const Row *row) const {
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (rows_[i].get() == row)
            return int(i);
    return -1;
}

QJsonValue ListEditor::value() const {
    if (rows_.empty() && !isGiven_ && place_.isOptional)
        return QJsonValue::Undefined;
    QJsonArray list;
    for (const auto &row : rows_) {
        const QJsonValue value = valueOf(*row);
        list.append(value.isUndefined() ? QJsonValue() : value); // which the schema refuses
    }
    return list;
}

void ListEditor::setValue(const QJsonValue &value) {
    const QJsonArray list = value.toArray();
    isGiven_ = !value.isUndefined();
    const bool isSameSize = list.size() == int(rows_.size());
    while (int(rows_.size()) > list.size()) {
        discard(rows_.back()->box);
        rows_.pop_back();
    }
    for (int i = 0; i < list.size(); ++i)
        if (i < int(rows_.size()))
            setRow(*rows_[std::size_t(i)], list[i]);
        else
            addRow(list[i]);
    number();
    if (!isSameSize)
        Q_EMIT rebuilt();
}

ListEditor::Row &ListEditor::addRow(const QJsonValue &value) {
    rows_.push_back(std::make_unique<Row>());
    Row &row = *rows_.back();
    const auto button = [](const char *name) {
        auto *const made = named(new QToolButton, name);
        made->setAutoRaise(true);
        return made;
    };
    row.up = button("up");
    row.down = button("down");
    row.remove = button("remove");
    row.up->setArrowType(Qt::UpArrow);
    row.down->setArrowType(Qt::DownArrow);
    row.remove->setIcon(theme::icon("remove"));
    QWidget *shown = nullptr;
    if (foldsOut_) {
        shown = row.fold = named(new QPushButton, "fold");
        row.fold->setFlat(true);
        row.fold->setStyleSheet("text-align: left");
        row.fold->setMinimumWidth(1);
        row.fold->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        connect(row.fold, &QPushButton::clicked, this, [this, &row] { unfold(row, !row.editor); });
        row.folded = value;
        showFolded(row);
    } else {
        makeRowEditor(row, value);
        shown = row.editor;
    }
    QLayout *const line = inRow(
        {{shown, 1}, {row.up, 0, Qt::AlignTop}, {row.down, 0, Qt::AlignTop}, {row.remove, 0, Qt::AlignTop}});
    line->setSpacing(2);
    row.box = filled(new QWidget, inColumn({line}), 2);
    connect(row.up, &QToolButton::clicked, this, [this, &row] { move(&row, -1); });
    connect(row.down, &QToolButton::clicked, this, [this, &row] { move(&row, 1); });
    connect(row.remove, &QToolButton::clicked, this, [this, &row] { remove(&row); });
    lines_->addWidget(row.box);
    return row;
}

void ListEditor::makeRowEditor(Row &row, const QJsonValue &value) {
    row.editor = makeEditor(item_, {place_.room, place_.depth, false, LineEditor::Empty::Absent});
    row.editor->setObjectName("element");
    row.editor->setToolTip(toolTipOf(item_["description"].toString()));
    row.editor->setValue(value);
    connect(row.editor, &ValueEditor::edited, this, [this, &row] {
        showFolded(row);
        Q_EMIT edited();
    });
    connect(row.editor, &ValueEditor::rebuilt, this, &ValueEditor::rebuilt);
}

void ListEditor::setRow(Row &row, const QJsonValue &value) {
    if (row.editor)
        row.editor->setValue(value);
    else
        row.folded = value;
    showFolded(row);
}

void ListEditor::unfold(Row &row, bool isUnfolded) {
    if (isUnfolded == (row.editor != nullptr))
        return;
    if (isUnfolded) {
        makeRowEditor(row, row.folded);
        row.editor->setContentsMargins(16, 0, 0, 0);
        row.box->layout()->addWidget(row.editor);
    } else {
        row.folded = row.editor->value();
        discard(row.editor);
        row.editor = nullptr;
    }
    showFolded(row);
    Q_EMIT rebuilt();
    Q_EMIT edited(); // what is wrong is marked in what was made
}

void ListEditor::showFolded(Row &row) {
    if (!row.fold)
        return;
    const QString summary = summaryOf(valueOf(row));
    const QString text = summary.isEmpty() ? tr("(empty)") : summary;
    row.fold->setText((row.editor ? u8"\u25be " : u8"\u25b8 ") + labelText(text));
    row.fold->setAccessibleName(text);
    row.fold->setToolTip(toolTipOf((row.editor ? tr("Folds up: ") : tr("Folds out: ")) + text));
}

void ListEditor::add() {
    Row &row = addRow(beginning(item_));
    if (row.fold)
        unfold(row, true);
    isGiven_ = true;
    number();
    Q_EMIT rebuilt();
    Q_EMIT edited();
    row.editor->setFocus();
}

void ListEditor::remove(const Row *row) {
    const int i = indexOf(row);
    discard(row->box);
    rows_.erase(rows_.begin() + i);
    number();
    Q_EMIT rebuilt();
    Q_EMIT edited();
    if (rows_.empty())
        add_->setFocus();
    else
        rows_[std::min(std::size_t(i), rows_.size() - 1)]->remove->setFocus();
}

void ListEditor::move(const Row *row, int by) {
    const int from = indexOf(row), to = from + by;
    if (to < 0 || to >= int(rows_.size()))
        return;
    Row &one = *rows_[std::size_t(from)], &other = *rows_[std::size_t(to)];
    const QJsonValue value = valueOf(one), others = valueOf(other);
    const bool isUnfolded = one.editor, isOtherUnfolded = other.editor;
    if (foldsOut_) {
        unfold(one, isOtherUnfolded);
        unfold(other, isUnfolded);
    }
    setRow(one, others);
    setRow(other, value);
    Q_EMIT edited();
    QToolButton *const next = by < 0 ? other.up : other.down; // to go on
    (next->isEnabled() ? next : by < 0 ? other.down : other.up)->setFocus();
}

void ListEditor::number() {
    const int count = int(rows_.size());
    for (int i = 0; i < count; ++i) {
        const Row &row = *rows_[std::size_t(i)];
        row.up->setEnabled(i > 0);
        row.down->setEnabled(i + 1 < count);
        const QString place = QString::number(i + 1);
        row.up->setToolTip(tr("Moves row %1 up").arg(place));
        row.down->setToolTip(tr("Moves row %1 down").arg(place));
        row.remove->setToolTip(tr("Removes row %1").arg(place));
        for (QToolButton *const button : {row.up, row.down, row.remove})
            button->setAccessibleName(button->toolTip());
    }
    const int most = std::min(maxRows, schema_["maxItems"].toInt(maxRows));
    add_->setEnabled(count < most);
    add_->setToolTip(count < most ? tr("Adds a row at the end") : tr("%1 rows are the most").arg(most));
    setFocusProxy(rows_.empty() ? static_cast<QWidget *>(add_) : focusOrder().constFirst());
}

void ListEditor::addFaults(const QString &path, Faults &faults) const {
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (rows_[i]->editor)
            rows_[i]->editor->addFaults(pathOf(path, QString::number(i)), faults);
}

void ListEditor::showFaults(const QString &path, const Faults &faults) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Row &row = *rows_[i];
        const QString place = pathOf(path, QString::number(i));
        if (row.editor)
            row.editor->showFaults(place, faults);
        if (!row.fold)
            continue;
        theme::tint(*row.fold, QPalette::ButtonText, theme::faultIf(faultAt(faults, place) != faults.end()));
    }
}

bool ListEditor::placeNote(QWidget *note) {
    delete foot_->takeAt(1); // the stretch
    foot_->addWidget(note, 1);
    return true;
}

QWidgetList ListEditor::focusOrder() const {
    QWidgetList order;
    for (const auto &row : rows_) {
        if (row->fold)
            order.append(row->fold);
        else
            order += row->editor->focusOrder();
        order += QWidgetList{row->up, row->down, row->remove};
        if (row->fold && row->editor)
            order += row->editor->focusOrder();
    }
    order.append(add_);
    return order;
}

} // namespace hermes::desktop
