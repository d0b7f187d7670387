#include "hv_replay/parameter_page.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace {

TEST(ParameterPage, IsTheDocumentationInTheRepository) {
  std::ifstream file(HV_PARAMETER_PAGE);
  ASSERT_TRUE(file) << HV_PARAMETER_PAGE << " cannot be opened";
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), hv::replay::ParameterPage())
      << "run: hv_parameters > docs/parameters.md";
}

}  // namespace
