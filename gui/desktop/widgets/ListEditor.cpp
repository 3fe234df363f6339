#include "gui/desktop/widgets/ListEditor.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/FieldText.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QJsonArray>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

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
    , lines_(new QVBoxLayout)
    , foot_(new QHBoxLayout)
    , add_(new QPushButton(theme::icon("add"), tr("Add"))) {
    auto *const layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(2);
    layout->addLayout(lines_);
    layout->addLayout(foot_);
    lines_->setSpacing(2);
    foot_->addWidget(add_);
    foot_->addStretch();
    add_->setObjectName("add");
    add_->setToolTip(tr("Adds a row at the end"));
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

QJsonValue ListEditor::valueOf(const Row &row) {
    return row.editor ? row.editor->value() : row.folded;
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
        rows_.back()->box->deleteLater();
        rows_.back()->box->hide();
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
    row.box = new QWidget;
    auto *const column = new QVBoxLayout(row.box);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(2);
    auto *const line = new QHBoxLayout;
    column->addLayout(line);
    line->setSpacing(2);
    if (foldsOut_) {
        row.fold = new QPushButton;
        row.fold->setObjectName("fold");
        row.fold->setFlat(true);
        row.fold->setStyleSheet("text-align: left");
        row.fold->setMinimumWidth(1);
        row.fold->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        line->addWidget(row.fold, 1);
        connect(row.fold, &QPushButton::clicked, this, [this, &row] { unfold(row, !row.editor); });
        row.folded = value;
        showFolded(row);
    } else {
        makeRowEditor(row, value);
        line->addWidget(row.editor, 1);
    }
    row.up = addButton(row, *line, "up");
    row.down = addButton(row, *line, "down");
    row.remove = addButton(row, *line, "remove");
    row.up->setArrowType(Qt::UpArrow);
    row.down->setArrowType(Qt::DownArrow);
    row.remove->setIcon(theme::icon("remove"));
    connect(row.up, &QToolButton::clicked, this, [this, &row] { move(&row, -1); });
    connect(row.down, &QToolButton::clicked, this, [this, &row] { move(&row, 1); });
    connect(row.remove, &QToolButton::clicked, this, [this, &row] { remove(&row); });
    lines_->addWidget(row.box);
    return row;
}

QToolButton *ListEditor::addButton(Row &row, QBoxLayout &line, const char *name) {
    auto *const button = new QToolButton(row.box);
    button->setObjectName(name);
    button->setAutoRaise(true);
    line.addWidget(button, 0, Qt::AlignTop);
    return button;
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
        row.editor->hide();
        row.editor->deleteLater();
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
    row.fold->setText((row.editor ? u8"\u25be " : u8"\u25b8 ") + QString(text).replace('&', "&&"));
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
    row->box->hide();
    row->box->deleteLater();
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
        QPalette palette;
        if (faultAt(faults, place) != faults.end())
            palette.setColor(QPalette::ButtonText, theme::colour(Condition::Fault));
        row.fold->setPalette(palette);
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
