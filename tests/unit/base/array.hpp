// Teuchos arrays from lists of values.
#pragma once

#include <Teuchos_Array.hpp>
#include <vector>

namespace sprekk::base {

template <class T>
Teuchos::Array<T> array(const std::vector<T>& values) {
  return Teuchos::Array<T>(values);
}

}  // namespace sprekk::base
