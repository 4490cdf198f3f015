#pragma once
// The model file format, in one table.

#include "talus/schema/schema.h"

namespace talus {

/// All sections, in the order of the documentation.
const Schema& model_schema();

/// Markdown tables of all sections, keys and units (a generated part of docs/file_format.md).
std::string model_markdown();

/// JSON Schema (draft 2020-12) for editors.
std::string model_json();

}  // namespace talus
