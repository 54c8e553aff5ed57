"""A live flight: the thread that flies it, what it leaves for pages, and the page that steers it."""
