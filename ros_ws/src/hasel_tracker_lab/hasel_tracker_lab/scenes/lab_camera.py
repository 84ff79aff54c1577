"""What a laboratory's camera makes of the light: blur, exposure, one colour per pixel, noise, half the colour."""

from dataclasses import dataclass

import cv2
import numpy as np


@dataclass(frozen=True)
class LabCamera:
    """blur_px: of the optics; exposure: factor on the light; noise_levels: of the sensor; bayer: one colour per
    pixel, interpolated; half_colour: 4:2:0; jpeg_quality: 0 for none."""

    blur_px: float = 0.7
    exposure: float = 1.0
    noise_levels: float = 2.5
    bayer: bool = True
    half_colour: bool = True
    jpeg_quality: int = 0

    def take(self, light: np.ndarray, random: np.random.Generator) -> np.ndarray:
        """An 8-bit BGR picture of the light (float32, BGR)."""
        light = cv2.GaussianBlur(light, (0, 0), self.blur_px) if self.blur_px else light
        light = light * self.exposure
        if self.bayer:
            mosaic = np.empty(light.shape[:2], np.float32)
            for row, column, channel in ((0, 0, 2), (0, 1, 1), (1, 0, 1), (1, 1, 0)):
                mosaic[row::2, column::2] = light[row::2, column::2, channel]
            mosaic += np.float32(random.normal(0.0, self.noise_levels, mosaic.shape))
            raw = np.clip(np.rint(mosaic), 0, 255).astype(np.uint8)
            image = cv2.demosaicing(raw, cv2.COLOR_BayerBG2BGR)  # OpenCV names the pattern by its second row
        else:
            noisy = light + random.normal(0.0, self.noise_levels, light.shape)
            image = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
        if self.jpeg_quality:
            coded = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, self.jpeg_quality])[1]
            return cv2.imdecode(coded, cv2.IMREAD_COLOR)
        if self.half_colour:
            image = _half_colour(image)
        return image


def _half_colour(image: np.ndarray) -> np.ndarray:
    """Keep luma in full and the mean colour of every two by two pixels (4:2:0, sited in their middle)."""
    parts = cv2.cvtColor(image, cv2.COLOR_BGR2YCrCb)
    height, width = image.shape[:2]
    colour = cv2.resize(parts[..., 1:], (width // 2, height // 2), interpolation=cv2.INTER_AREA)
    parts[..., 1:] = cv2.resize(colour, (width, height), interpolation=cv2.INTER_LINEAR)
    return cv2.cvtColor(parts, cv2.COLOR_YCrCb2BGR)
