#include "record.h"

#include <algorithm>
#include <cctype>
#include <map>

namespace carom_python {

namespace {

// The last [...] of a text that is no range of numbers.
std::string unit_in(const std::string& text) {
  std::size_t close = text.rfind(']');
  while (close != std::string::npos) {
    const std::size_t open = text.rfind('[', close);
    if (open == std::string::npos) return {};
    const bool ends =
        close + 1 == text.size() || std::string_view(".;: ").find(text[close + 1]) != std::string::npos;
    const std::string inside = text.substr(open + 1, close - open - 1);
    const bool is_range =
        inside.find(", ") != std::string::npos && std::isdigit(static_cast<unsigned char>(inside[0])) != 0;
    if (ends && !inside.empty() && !is_range && inside.find('i') != 0) return inside;
    if (open == 0) return {};
    close = text.rfind(']', open - 1);
  }
  return {};
}

// As it may stand in a signature: numbers, texts and None; "..." for all else.
std::string literal(nb::handle value) {
  PyObject* const raw = value.ptr();
  if (value.is_none() || PyBool_Check(raw) || PyLong_Check(raw) || PyUnicode_Check(raw)) {
    return nb::cast<std::string>(nb::repr(value));
  }
  if (PyFloat_Check(raw)) {
    const double number = PyFloat_AsDouble(raw);
    if (number - number == 0.0) return nb::cast<std::string>(nb::repr(value));
  }
  return "...";
}

std::map<PyObject*, const Record*>& by_type() {
  static std::map<PyObject*, const Record*> table;
  return table;
}

void add_property(nb::handle type, const Record& record, const Field& field) {
  const std::string path = record.name + "." + field.name;
  const auto get = [&record, &field](nb::handle self) {
    if (PyObject_IsInstance(self.ptr(), record.type.ptr()) != 1) refuse("self", record.name, self);
    return field.type->cast(field.of(nb::inst_ptr<void>(self)));
  };
  const std::string getter = "def " + field.python() + "(self) -> " + field.type->names.gives;
  const std::string setter =
      "def " + field.python() + "(self, value: " + field.type->names.accepts + ") -> None";
  // Without a scope: the setter would become an overload of the getter there.
  nb::object read =
      nb::cpp_function(get, nb::is_getter(), nb::is_method(), nb::sig(getter.c_str()), field.doc.c_str());
  nb::object write = nb::none();
  if (record.writable && field.type->load != nullptr) {
    write = nb::cpp_function(
        [&record, &field, path](nb::handle self, nb::handle value) {
          if (PyObject_IsInstance(self.ptr(), record.type.ptr()) != 1) refuse("self", record.name, self);
          field.type->load(value, field.of(nb::inst_ptr<void>(self)), path);
        },
        nb::is_method(), nb::sig(setter.c_str()), nb::arg("value").none());
  }
  const nb::handle property(reinterpret_cast<PyObject*>(&PyProperty_Type));
  nb::setattr(type, field.python().c_str(), property(read, write, nb::none(), nb::str(field.doc.c_str())));
}

}  // namespace

std::vector<Record*>& records() {
  static std::vector<Record*> all;
  return all;
}

const Record* record_of(nb::handle type) {
  const auto found = by_type().find(type.ptr());
  return found != by_type().end() ? found->second : nullptr;
}

std::vector<std::string> Record::field_names() const {
  std::vector<std::string> names;
  for (const Field& field : fields) names.push_back(field.python());
  return names;
}

const Field* Record::find(std::string_view field) const {
  const auto found = std::ranges::find_if(
      fields, [&](const Field& each) { return each.name == field || each.python() == field; });
  return found != fields.end() ? &*found : nullptr;
}

void Record::set(void* record, const nb::args& given, const nb::kwargs& named) const {
  if (given.size() > 1) {
    const std::string text = name + " takes one argument without its name; give the others as " +
                             (fields.size() > 1 ? fields[1].name : fields[0].name) + "=...";
    throw nb::type_error(text.c_str());
  }
  if (given.size() == 1)
    fields.front().type->load(given[0], fields.front().of(record), fields.front().argument);
  std::size_t seen = given.size();
  for (const auto& [key, value] : named) {
    const auto word = nb::cast<std::string_view>(key);
    const Field* const field = find(word);
    if (field == nullptr || (given.size() == 1 && field == &fields.front())) {
      std::string text =
          name + (field == nullptr ? " has no argument '" : " has two values of '") + std::string(word) + "'";
      text += "; arguments:";
      for (const Field& each : fields) text += (&each == &fields.front() ? " " : ", ") + each.python();
      if (field == nullptr) text += nearest_of(word, field_names());
      throw nb::type_error(text.c_str());
    }
    field->type->load(value, field->of(record), field->argument);
    ++seen;
  }
  for (const Field& field : fields) {
    const bool first = &field == &fields.front() && given.size() == 1;
    if (!field.required || first || named.contains(field.name.c_str())) continue;
    if (named.contains(field.python().c_str())) continue;
    throw nb::type_error((field.argument + " is missing: " + field.doc).c_str());
  }
}

void Record::set_from(void* record, const nb::dict& named, std::string_view where) const {
  const std::string place(where);
  for (const auto& [key, value] : named) {
    const Field* const field = nb::isinstance<nb::str>(key) ? find(nb::cast<std::string_view>(key)) : nullptr;
    if (field == nullptr || field->type->load == nullptr) {
      std::string text = place + ": " + name + " has no field " + nb::cast<std::string>(nb::repr(key));
      text += "; fields:";
      for (const Field& each : fields) text += (&each == &fields.front() ? " " : ", ") + each.python();
      if (nb::isinstance<nb::str>(key)) text += nearest_of(nb::cast<std::string_view>(key), field_names());
      throw nb::type_error(text.c_str());
    }
    field->type->load(value, field->of(record), place + "['" + field->name + "']");
  }
  for (const Field& field : fields) {
    if (!field.required || named.contains(field.name.c_str()) || named.contains(field.python().c_str()))
      continue;
    throw nb::type_error(
        (place + ": field '" + field.name + "' of " + name + " is missing: " + field.doc).c_str());
  }
}

std::string Record::text(const void* record) const {
  std::string shown = name + "(";
  for (const Field& field : fields) {
    const nb::object value = field.type->cast(field.of(record));
    std::string now = nb::cast<std::string>(nb::repr(value));
    if (nb::isinstance<nb::str>(value) || !nb::hasattr(value, "tolist")) {
      if (writable && !field.required && now == nb::cast<std::string>(nb::repr(field.default_value)))
        continue;
    } else {
      now = nb::cast<std::string>(nb::repr(value.attr("tolist")()));
      if (writable && !field.required &&
          now == nb::cast<std::string>(nb::repr(field.default_value.attr("tolist")()))) {
        continue;
      }
    }
    shown += (shown.back() == '(' ? "" : ", ") + field.python() + "=" + now;
  }
  return shown + ")";
}

std::string Record::signature() const {
  std::string text = "def __init__(self";
  bool star = false;
  for (const Field& field : fields) {
    const bool first = &field == &fields.front();
    if (!first && !star) {
      text += ", *";
      star = true;
    }
    text += ", " + field.python() + ": " + field.type->names.accepts;
    if (!field.required) text += " = " + literal(field.default_value);
  }
  return text + ") -> None";
}

void finish_record(Record& record, nb::handle type, const std::vector<std::string>& keys,
                   const void* defaults) {
  record.type = type;
  for (Field& field : record.fields) {
    for (const std::string& key : keys) {
      field.doc = doc(key + "." + field.name);
      if (!field.doc.empty()) break;
    }
    field.unit = unit_in(field.doc);
    field.argument = record.name + ": argument '" + field.name + "'";
    field.default_value = field.type->cast(field.of(defaults)).release();
    add_property(type, record, field);
  }
  by_type()[type.ptr()] = &record;
  records().push_back(&record);
}

}  // namespace carom_python
