// Words kept in an image, four to a texel and word_row texels to a row, or one to a texel and 4 word_row. On lavapipe a fetch
// gathers all lanes at once, where a load by buffer address is a loop over them.
uvec4 fetch_words(usampler2D words, uint texel) {
  return texelFetch(words, ivec2(texel % word_row, texel / word_row), 0);
}
uint fetch_word(usampler2D words, uint place) {
  return texelFetch(words, ivec2(place % (4u * word_row), place / (4u * word_row)), 0).x;
}
