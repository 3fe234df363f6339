#include "gui/desktop/widgets/ObjectEditor.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/FieldText.h"
#include "gui/desktop/widgets/PlainLabel.h"

#include <QGridLayout>
#include <QJsonArray>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QToolButton>
#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr int maxMembers = 100;

/// Its keys are not only those that the schema names.
bool isOpen(const QJsonObject &schema) {
    const QJsonValue additional = schema["additionalProperties"];
    return additional.isUndefined() ? !schema["properties"].isObject()
                                    : additional.isObject() || additional.toBool();
}

} // namespace

QString ObjectEditor::Row::name() const {
    return freeKey ? freeKey->text() : key;
}

ObjectEditor::ObjectEditor(const QJsonObject &schema, const EditorPlace &place, QWidget *parent)
    : ValueEditor(parent)
    , schema_(schema)
    , properties_(schema["properties"].toObject())
    , place_(place)
    , grid_(new QGridLayout)
    , field_(named(new QPushButton(theme::icon("add"), tr("Add a value")), "addField",
                   tr("Values that may be given")))
    , free_(named(new QPushButton(theme::icon("add"), tr("Add")), "addFree",
                  tr("Adds a row with a name and a value")))
    , foot_(inRow({field_, free_, Part::room()}))
    , absent_(new QMenu(this)) {
    filled(this, inColumn({grid_, foot_}), 2);
    grid_->setVerticalSpacing(2);
    grid_->setColumnStretch(EditorColumn, 3);
    grid_->setColumnStretch(NoteColumn, 2);
    field_->setMenu(absent_);
    free_->setVisible(isOpen(schema));
    connect(free_, &QPushButton::clicked, this, &ObjectEditor::addFree);
    connect(absent_, &QMenu::triggered, this,
            [this](const QAction *chosen) { addField(chosen->data().toString()); });
    setFocusProxy(isOpen(schema) ? free_ : field_);
}

ObjectEditor::~ObjectEditor() = default;

bool ObjectEditor::isRequired(const QString &key) const {
    return schema_["required"].toArray().contains(key);
}

ObjectEditor::Row *ObjectEditor::find(const QString &key) const {
    for (const auto &row : rows_)
        if (row->name() == key)
            return row.get();
    return nullptr;
}

QJsonValue ObjectEditor::value() const {
    QJsonObject object;
    for (const auto &row : rows_)
        if (const QJsonValue value = row->editor->value(); !value.isUndefined())
            object[row->name()] = value;
        else if (row->remove)
            object[row->name()] = QJsonValue(); // it is there, and nothing is typed: the schema refuses it
    return object.isEmpty() && !isGiven_ && place_.isOptional ? QJsonValue(QJsonValue::Undefined)
                                                              : QJsonValue(object);
}

void ObjectEditor::setValue(const QJsonValue &value) {
    const QJsonObject object = value.toObject();
    isGiven_ = !value.isUndefined();
    QStringList keys, shown;
    for (auto property = properties_.begin(); property != properties_.end(); ++property)
        if (keys.size() < maxMembers && (isRequired(property.key()) || object.contains(property.key())))
            keys.append(property.key());
    for (auto member = object.begin(); member != object.end(); ++member)
        if (!properties_.contains(member.key()))
            keys.append(member.key());
    const auto rank = [this](const QString &key) {
        return !isRequired(key) ? 2 : key == "name" || key == "id" ? 0 : 1;
    };
    std::stable_sort(keys.begin(), keys.end(),
                     [&](const QString &one, const QString &other) { return rank(one) < rank(other); });
    for (const auto &row : rows_)
        shown.append(row->name());
    if (std::is_permutation(keys.begin(), keys.end(), shown.begin(), shown.end())) {
        for (const auto &row : rows_)
            row->editor->setValue(object[row->name()]);
        return;
    }
    clear();
    for (const QString &key : qAsConst(keys))
        addRow(key, object[key], !properties_.contains(key));
    offer();
    Q_EMIT rebuilt();
}

void ObjectEditor::clear() {
    while (!rows_.empty()) {
        for (QWidget *const widget : qAsConst(rows_.back()->widgets))
            discard(widget);
        rows_.pop_back();
    }
}

ObjectEditor::Row &ObjectEditor::addRow(const QString &key, const QJsonValue &value, bool isFree) {
    rows_.push_back(std::make_unique<Row>());
    Row &row = *rows_.back();
    row.key = key;
    row.schema = isFree ? schema_["additionalProperties"].toObject() : properties_[key].toObject();
    const bool isMust = !isFree && isRequired(key);
    row.editor = makeEditor(row.schema, {place_.room, place_.depth, false,
                                         isMust ? LineEditor::Empty::Absent : LineEditor::Empty::Text});
    row.editor->setObjectName("member " + key.left(100));
    row.editor->setEnabled(!row.schema["readOnly"].toBool());
    row.editor->setValue(value);
    row.note = named(new PlainLabel, "note");
    row.note->letWrap();
    auto *const unit = new PlainLabel(shownUnit(row.schema));
    row.widgets = {makeTitle(row), row.editor, unit, row.note};
    const bool isWide = row.editor->placeNote(row.note);
    grid_->addWidget(row.widgets[0], line_, TitleColumn, isWide ? Qt::AlignTop : Qt::AlignVCenter);
    grid_->addWidget(row.editor, line_, EditorColumn, 1, isWide ? 3 : 1);
    if (!isWide) {
        grid_->addWidget(unit, line_, UnitColumn);
        grid_->addWidget(row.note, line_, NoteColumn);
    }
    unit->setParent(isWide ? this : unit->parentWidget());
    unit->setVisible(!isWide);
    if (!isMust) {
        const QString toolTip = tr("Leaves %1 out").arg(shortLine(key, longestTitle));
        row.remove = named(new QToolButton, "remove", toolTipOf(toolTip));
        row.remove->setAutoRaise(true);
        row.remove->setText(u8"\u2715"); // a row of a list has a minus
        row.remove->setAccessibleName(toolTip);
        connect(row.remove, &QToolButton::clicked, this, [this, &row] { remove(&row); });
        grid_->addWidget(row.remove, line_, RemoveColumn, isWide ? Qt::AlignTop : Qt::AlignVCenter);
        row.widgets.append(row.remove);
    }
    ++line_;
    for (QWidget *const widget : {row.widgets[0], static_cast<QWidget *>(row.editor)})
        widget->setToolTip(toolTipOf(explanation(key.left(100), row.schema)));
    connect(row.editor, &ValueEditor::edited, this, &ValueEditor::edited);
    connect(row.editor, &ValueEditor::rebuilt, this, &ValueEditor::rebuilt);
    return row;
}

QWidget *ObjectEditor::makeTitle(Row &row) {
    if (!properties_.contains(row.key)) {
        row.freeKey = named(new QLineEdit(row.key), "key");
        row.freeKey->setPlaceholderText(tr("name"));
        row.freeKey->setAccessibleName(tr("Name of the value"));
        row.freeKey->setMinimumWidth(80);
        connect(row.freeKey, &QLineEdit::textEdited, this, &ValueEditor::edited);
        return row.freeKey;
    }
    auto *const title = new PlainLabel(labelText(shortLine(titleOf(row.key, row.schema), longestTitle)));
    title->setBuddy(row.editor);
    title->setMargin(3);
    return title;
}

void ObjectEditor::addField(const QString &key) {
    const QJsonObject schema = properties_[key].toObject();
    Row &row = addRow(key, schema["default"], false);
    isGiven_ = true;
    offer();
    Q_EMIT rebuilt();
    Q_EMIT edited();
    row.editor->setFocus();
}

void ObjectEditor::addFree() {
    const Row &row = addRow({}, schema_["additionalProperties"]["default"], true);
    isGiven_ = true;
    offer();
    Q_EMIT rebuilt();
    Q_EMIT edited();
    row.freeKey->setFocus();
}

void ObjectEditor::remove(const Row *row) {
    const auto found =
        std::find_if(rows_.begin(), rows_.end(), [row](const auto &one) { return one.get() == row; });
    for (QWidget *const widget : row->widgets)
        discard(widget);
    rows_.erase(found);
    offer();
    Q_EMIT rebuilt();
    Q_EMIT edited();
    (field_->isVisibleTo(this) ? field_ : free_)->setFocus();
}

/// What may be given and is not.
void ObjectEditor::offer() {
    absent_->clear();
    bool hasOptional = false;
    for (auto property = properties_.begin(); property != properties_.end(); ++property) {
        hasOptional = hasOptional || !isRequired(property.key());
        if (find(property.key()) || absent_->actions().size() >= maxMembers)
            continue;
        const QString title = shortLine(titleOf(property.key(), property->toObject()), longestTitle);
        QAction *const action = absent_->addAction(labelText(title));
        action->setData(property.key());
        action->setToolTip(toolTipOf(property->toObject()["description"].toString()));
    }
    absent_->setToolTipsVisible(true);
    field_->setVisible(hasOptional);
    field_->setEnabled(!absent_->isEmpty());
    free_->setEnabled(int(rows_.size()) < maxMembers);
    const QWidgetList order = focusOrder();
    setFocusProxy(order.isEmpty() ? nullptr : order.constFirst());
}

void ObjectEditor::addFaults(const QString &path, Faults &faults) const {
    for (const auto &row : rows_) {
        const QString name = row->name();
        row->editor->addFaults(pathOf(path, name), faults);
        if (row->freeKey && name.isEmpty())
            faults[pathOf(path, name)] = tr("a name");
        if (row->freeKey && find(name) != row.get())
            faults[pathOf(path, name)] = tr("a name that is there only once");
    }
}

void ObjectEditor::showFaults(const QString &path, const Faults &faults) {
    for (const auto &row : rows_) {
        const QString place = pathOf(path, row->name());
        row->editor->showFaults(place, faults);
        const QString fault = faultText(faults, place, row->schema);
        row->note->setText(shortLine(fault.isEmpty() ? limitsOf(row->schema) : fault, longestNote));
        theme::tint(*row->note, QPalette::WindowText, theme::faultIf(!fault.isEmpty()));
    }
}

bool ObjectEditor::placeNote(QWidget *note) {
    delete foot_->takeAt(2); // the stretch
    foot_->addWidget(note, 1);
    return true;
}

QWidgetList ObjectEditor::focusOrder() const {
    QWidgetList order;
    for (const auto &row : rows_) {
        if (row->freeKey)
            order.append(row->freeKey);
        order += row->editor->focusOrder();
        if (row->remove)
            order.append(row->remove);
    }
    if (field_->isVisibleTo(this))
        order.append(field_);
    if (free_->isVisibleTo(this))
        order.append(free_);
    return order;
}

} // namespace hermes::desktop
