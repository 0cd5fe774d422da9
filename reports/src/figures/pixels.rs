//! PNG output.

use resvg::{tiny_skia, usvg};

/// Renders the picture at twice its size on a screen.
///
/// # Errors
/// A picture that is too large.
pub(super) fn png(tree: &usvg::Tree) -> Result<Vec<u8>, String> {
    let size = tree.size().to_int_size().scale_by(2.0).ok_or("the picture is too large")?;
    let (width, height) = (size.width(), size.height());
    let mut pixels = tiny_skia::Pixmap::new(width, height)
        .ok_or_else(|| format!("{width} x {height} pixels do not fit in memory"))?;
    pixels.fill(tiny_skia::Color::WHITE);
    resvg::render(tree, tiny_skia::Transform::from_scale(2.0, 2.0), &mut pixels.as_mut());
    // Every pixel of a white sheet is opaque, so three of its four bytes suffice.
    let mut colours = Vec::with_capacity(pixels.data().len() / 4 * 3);
    pixels.data().chunks_exact(4).for_each(|pixel| colours.extend_from_slice(&pixel[..3]));
    packed(width, height, &colours).map_err(|e| e.to_string())
}

/// Encodes the pixels as PNG. The encoder of tiny-skia took a third of a report's time; the lowest level
/// takes a sixth of this and makes files a third larger.
fn packed(width: u32, height: u32, colours: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_deflate_compression(png::DeflateCompression::Level(1));
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(colours)?;
    writer.finish()?;
    Ok(file)
}
