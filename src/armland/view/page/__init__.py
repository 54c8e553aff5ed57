"""Reports as pages: one self-contained HTML file each, without network, for screen in light and dark and for print."""
