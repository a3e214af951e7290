#include "tools/base/limits/jpeg.h"

#include <array>
#include <csetjmp>
#include <vector>

// clang-format off
#include <cstdio>
#include <jpeglib.h>  // needs cstdio
#include <jerror.h>   // needs jpeglib.h
// clang-format on

namespace limits {
namespace {

constexpr int kMostLeft = 64;  // bytes that cameras leave behind the data

struct Errors : jpeg_error_mgr {
  std::jmp_buf leave;
  std::array<char, JMSG_LENGTH_MAX> problem{};  // the first
};

void Note(j_common_ptr decoder) {
  auto& errors = static_cast<Errors&>(*decoder->err);
  if (errors.problem[0] == '\0') errors.format_message(decoder, errors.problem.data());
}

[[noreturn]] void Leave(j_common_ptr decoder) {
  Note(decoder);
  std::longjmp(static_cast<Errors&>(*decoder->err).leave, 1);
}

// level: -1 of a warning, above of a trace.
void OnMessage(j_common_ptr decoder, int level) {
  const int code = decoder->err->msg_code;
  const bool is_damage = code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE || code == JWRN_MUST_RESYNC ||
                         code == JWRN_ARITH_BAD_CODE || code == JWRN_JPEG_EOF ||
                         (code == JWRN_EXTRANEOUS_DATA && decoder->err->msg_parm.i[0] > kMostLeft);
  if (level < 0 && is_damage) Note(decoder);
}

// Reads all codes of the data. Buffer of a row: of the caller, as an error leaves this function by longjmp.
void ReadAll(jpeg_decompress_struct& decoder, std::vector<std::uint8_t>& row) {
  // An eighth of the size: one coefficient of each block is used.
  decoder.scale_num = 1, decoder.scale_denom = 8;
  decoder.out_color_space = decoder.jpeg_color_space;
  decoder.do_fancy_upsampling = FALSE;
  jpeg_start_decompress(&decoder);
  row.resize(std::size_t{decoder.output_width} * static_cast<std::size_t>(decoder.output_components));
  for (JSAMPROW at = row.data(); decoder.output_scanline < decoder.output_height;)
    jpeg_read_scanlines(&decoder, &at, 1);
  jpeg_finish_decompress(&decoder);
}

}  // namespace

std::string JpegDataProblem(std::span<const std::uint8_t> file) {
  Errors errors;
  std::vector<std::uint8_t> row;
  jpeg_decompress_struct decoder;
  decoder.err = jpeg_std_error(&errors);
  errors.error_exit = Leave;
  errors.emit_message = OnMessage;
  jpeg_create_decompress(&decoder);
  if (setjmp(errors.leave) == 0) {
    jpeg_mem_src(&decoder, file.data(), file.size());
    jpeg_read_header(&decoder, TRUE);
    if (decoder.progressive_mode == FALSE) ReadAll(decoder, row);
  }
  jpeg_destroy_decompress(&decoder);
  return errors.problem[0] == '\0' ? "" : "damaged JPEG: " + std::string(errors.problem.data());
}

}  // namespace limits
